// SPDX-License-Identifier: MIT
#include "report/reproducer/fault_case.h"

#include <algorithm>
#include <bit>
#include <map>

#include "engine/accel/geometry.h"
#include "engine/accel/morton_order.h"
#include "validation/reference/geometry64.h"

namespace twinray::reproducer {
namespace {

using Bits = std::array<std::uint32_t, 3>;

Bits bits_of(const vec3& p) {
    return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y), std::bit_cast<std::uint32_t>(p.z)};
}

// A mesh that grows by triangles.
class MeshMaker {
  public:
    void add(const std::array<vec3, 3>& vertices) {
        mesh_.triangles.emplace_back(vertex(vertices[0]), vertex(vertices[1]), vertex(vertices[2]));
    }
    Mesh mesh() && { return std::move(mesh_); }

  private:
    uint vertex(const vec3& p) {
        const auto [at, is_new] = numbers_.try_emplace(bits_of(p), static_cast<uint>(mesh_.positions.size()));
        if (is_new) mesh_.positions.push_back(p);
        return at->second;
    }

    Mesh mesh_;
    std::map<Bits, uint> numbers_;
};

// Computes in float64, in world space.
bool is_near(const CaseTriangle& triangle, const Transform& transform, const Ray& ray) {
    dvec3 lo(transform_point(transform, triangle.vertices[0])), hi = lo;
    for (const vec3& vertex : triangle.vertices) {
        const dvec3 p(transform_point(transform, vertex));
        lo = min(lo, p);
        hi = max(hi, p);
    }
    const dvec3 size = hi - lo, reach(0.25 * std::max({size.x, size.y, size.z}));
    const dvec3 origin(ray.origin), direction(ray.direction);
    double enter = -unlimited, leave = unlimited;
    for (int axis = 0; axis < 3; ++axis) {
        const double below = lo[axis] - reach[axis] - origin[axis], above = hi[axis] + reach[axis] - origin[axis];
        if (direction[axis] == 0) {
            if (below > 0 || above < 0) return false;
            continue;
        }
        const double a = below / direction[axis], b = above / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

}  // namespace

FaultCase near_the_ray(const FaultCase& fault, std::size_t instance, std::size_t also) {
    FaultCase near{fault.transforms, {}, fault.ray};
    std::vector<std::size_t> counts(fault.transforms.size());
    for (const CaseTriangle& triangle : fault.triangles) {
        const bool is_wanted = triangle.instance == instance && counts[triangle.instance] == also;
        ++counts[triangle.instance];
        if (is_wanted || is_near(triangle, fault.transforms[triangle.instance], fault.ray))
            near.triangles.push_back(triangle);
    }
    return near;
}

FaultCase case_of(const Scene& scene, const Ray& ray, bool reorders) {
    FaultCase fault;
    fault.ray = ray;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        std::vector<uvec3> triangles = mesh.triangles;
        if (reorders) {
            const std::vector<uint> order = morton_order(triangle_centers(mesh.positions, mesh.triangles));
            std::ranges::transform(order, triangles.begin(), [&](uint i) { return mesh.triangles[i]; });
        }
        for (const uvec3& t : triangles) {
            const std::array<vec3, 3> vertices = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
            if (std::ranges::all_of(vertices, [](const vec3& v) { return is_finite(v); }))
                fault.triangles.push_back({fault.transforms.size(), vertices});
        }
        fault.transforms.push_back(instance.transform);
    }
    return fault;
}

FaultCase as_built(const FaultCase& fault) {
    FaultCase built = fault;
    for (std::size_t instance = 0; instance < built.transforms.size(); ++instance) {
        std::vector<vec3> vertices;
        for (const CaseTriangle& triangle : fault.triangles)
            if (triangle.instance == instance)
                vertices.insert(vertices.end(), triangle.vertices.begin(), triangle.vertices.end());
        const float unit = Geometry::near_unit(vertices);
        for (CaseTriangle& triangle : built.triangles)
            if (triangle.instance == instance)
                for (vec3& vertex : triangle.vertices) vertex *= 1 / unit;
        for (vec4& row : built.transforms[instance].rows) row = vec4(vec3(row) * unit, row.w);
    }
    return built;
}

Scene scene_of(const FaultCase& fault) {
    Scene scene;
    for (std::size_t instance = 0; instance < fault.transforms.size(); ++instance) {
        MeshMaker maker;
        for (const CaseTriangle& triangle : fault.triangles)
            if (triangle.instance == instance) maker.add(triangle.vertices);
        Mesh mesh = std::move(maker).mesh();
        if (mesh.triangles.empty()) continue;
        scene.instances.push_back({"", static_cast<uint>(scene.meshes.size()), fault.transforms[instance]});
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

}  // namespace twinray::reproducer
