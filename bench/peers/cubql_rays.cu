// cuBQL's hits of rays, for python_rays.py: `cubql_rays closest|any` in a folder with a mesh and rays. Compiled by nvcc
// it uses the GPU, and by another compiler the CPU.
#ifndef __CUDACC__
#include <algorithm>
#define __device__ // its triangle test has CUDA's words, without a condition
using std::max;
#endif

#include "cuBQL/bvh.h"
#include "cuBQL/queries/triangleData/math/rayTriangleIntersections.h"
#include "cuBQL/traversal/rayQueries.h"

#ifdef __CUDACC__
#define CUBQL_GPU_BUILDER_IMPLEMENTATION 1
#include "cuBQL/builder/cuda.h"
#endif

#include "bench/peers/peer_program.h"

namespace {

using cuBQL::box3f;
using cuBQL::bvh3f;
using cuBQL::vec3f;

struct Scene {
    const vec3f* vertices;
    const cuBQL::vec3i* triangles;
    bvh3f bvh;
};

__cubql_both cuBQL::Triangle triangle_of(const Scene& scene, uint32_t index) {
    const cuBQL::vec3i at = scene.triangles[index];
    return {scene.vertices[at.x], scene.vertices[at.y], scene.vertices[at.z]};
}

// Returns infinity if nothing is hit.
__cubql_both float distance(const Scene& scene, const peer::Ray& given, bool is_any) {
    cuBQL::ray3f ray(vec3f(given.origin[0], given.origin[1], given.origin[2]),
                     vec3f(given.direction[0], given.direction[1], given.direction[2]), 0.f, CUBQL_INF);
    float found = CUBQL_INF;
    if (is_any) {
        const auto visit = [&](uint32_t index) {
            cuBQL::RayTriangleIntersection hit;
            if (!hit.compute(ray, triangle_of(scene, index))) return CUBQL_CONTINUE_TRAVERSAL;
            found = hit.t;
            return CUBQL_TERMINATE_TRAVERSAL;
        };
        cuBQL::fixedRayQuery::forEachPrim(visit, scene.bvh, ray);
        return found;
    }
    const auto visit = [&](uint32_t index) {
        cuBQL::RayTriangleIntersection hit;
        if (hit.compute(ray, triangle_of(scene, index)) && hit.t < found) {
            found = hit.t;
            ray.tMax = hit.t;
        }
        return ray.tMax;
    };
    cuBQL::shrinkingRayQuery::forEachPrim(visit, scene.bvh, ray);
    return found;
}

cuBQL::BuildConfig config() {
    cuBQL::BuildConfig config;
    config.makeLeafThreshold = 4;
    return config;
}

#ifdef __CUDACC__
__global__ void box_all(Scene scene, box3f* boxes, uint32_t count) {
    const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < count) boxes[i] = triangle_of(scene, i).bounds();
}
__global__ void trace_all(Scene scene, const peer::Ray* rays, float* distances, uint32_t count, bool is_any) {
    const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < count) distances[i] = distance(scene, rays[i], is_any);
}

void run(const std::vector<vec3f>& vertices, const std::vector<cuBQL::vec3i>& triangles,
         const std::vector<peer::Ray>& rays, bool is_any) {
    constexpr uint32_t group = 128;
    const auto groups = [](std::size_t count) { return static_cast<uint32_t>((count + group - 1) / group); };
    Scene scene{peer::on_device(vertices), peer::on_device(triangles), {}};
    const auto count = static_cast<uint32_t>(triangles.size());
    box3f* const boxes = peer::device_array<box3f>(count);
    box_all<<<groups(count), group>>>(scene, boxes, count);
    cuBQL::gpuBuilder(scene.bvh, boxes, count, config());
    const peer::Ray* const given = peer::on_device(rays);
    float* const found = peer::device_array<float>(rays.size());
    peer::time([&] {
        trace_all<<<groups(rays.size()), group>>>(scene, given, found, static_cast<uint32_t>(rays.size()), is_any);
        peer::check(cudaDeviceSynchronize());
    });
    peer::write_distances(peer::on_host(found, rays.size()));
}
#else
void run(const std::vector<vec3f>& vertices, const std::vector<cuBQL::vec3i>& triangles,
         const std::vector<peer::Ray>& rays, bool is_any) {
    Scene scene{vertices.data(), triangles.data(), {}};
    std::vector<box3f> boxes;
    for (uint32_t i = 0; i < triangles.size(); ++i) boxes.push_back(triangle_of(scene, i).bounds());
    cuBQL::cpu::spatialMedian(scene.bvh, boxes.data(), static_cast<uint32_t>(boxes.size()), config());
    std::vector<float> found(rays.size());
    peer::time([&] {
#pragma omp parallel for schedule(dynamic, 1024)
        for (std::size_t i = 0; i < rays.size(); ++i) found[i] = distance(scene, rays[i], is_any);
    });
    peer::write_distances(found);
}
#endif

}  // namespace

int main(int, char** arguments) try {
    static_assert(sizeof(vec3f) == 12 && sizeof(cuBQL::vec3i) == 12);
    run(peer::read<vec3f>("vertices"), peer::read<cuBQL::vec3i>("triangles"), peer::read<peer::Ray>("rays"),
        std::string(arguments[1]) == "any");
} catch (const std::exception& error) {
    std::fprintf(stderr, "cubql_rays: %s\n", error.what());
    return 1;
}
