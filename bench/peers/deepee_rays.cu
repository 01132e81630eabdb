// deepeeRT's hits of rays, in float64, for python_rays.py: `deepee_rays closest|any` in a folder with a mesh and rays.
// It has no query for any hit: `any` is the closest.
#include <dprt/dprt.h>

#include "bench/peers/peer_program.h"

namespace {

std::vector<DPRTvec3> widened(const std::vector<float>& numbers) {
    std::vector<DPRTvec3> points;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    return points;
}

std::vector<DPRTRay> widened(const std::vector<peer::Ray>& rays) {
    std::vector<DPRTRay> wide;
    for (const peer::Ray& ray : rays)
        wide.push_back({{ray.origin[0], ray.origin[1], ray.origin[2]},
                        {ray.direction[0], ray.direction[1], ray.direction[2]},
                        0,
                        1e30});
    return wide;
}

}  // namespace

int main() try {
    const std::vector<DPRTvec3> vertices = widened(peer::read<float>("vertices"));
    const std::vector<DPRTint3> triangles = peer::read<DPRTint3>("triangles");
    const std::vector<DPRTRay> rays = widened(peer::read<peer::Ray>("rays"));
    const DPRTContext context = dprtContextCreate(DPRT_CONTEXT_GPU, 0);
    DPRTTriangles mesh = dprtCreateTriangles(context, 0, peer::on_device(vertices), vertices.size(),
                                             peer::on_device(triangles), triangles.size());
    DPRTGroup group = dprtCreateTrianglesGroup(context, &mesh, 1);
    const DPRTModel model = dprtCreateModel(context, &group, nullptr, 1);
    DPRTRay* const given = peer::on_device(rays);
    DPRTHit* const hits = peer::device_array<DPRTHit>(rays.size());
    peer::time([&] {
        dprtTrace(model, given, hits, static_cast<int>(rays.size()));
        peer::check(cudaDeviceSynchronize());
    });
    std::vector<float> distances;
    for (const DPRTHit& hit : peer::on_host(hits, rays.size()))
        distances.push_back(hit.primID < 0 ? INFINITY : static_cast<float>(hit.t));
    peer::write_distances(distances);
} catch (const std::exception& error) {
    std::fprintf(stderr, "deepee_rays: %s\n", error.what());
    return 1;
}
