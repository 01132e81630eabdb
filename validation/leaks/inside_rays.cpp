// SPDX-License-Identifier: MIT
#include "validation/leaks/inside_rays.h"

#include <limits>

#include "validation/reference/draws.h"
#include "validation/reference/geometry64.h"
#include "engine/core/parallel.h"
#include "validation/reference/error_bounds.h"

namespace twinray {
namespace {

// Returns whether a float32 kernel may find a triangle behind the origin that lies before it, or the other way round.
bool is_undecided_at_origin(const ClosedMesh& mesh, const Ray& ray) {
    const ErrorBounds bounds(ray, Placement64(), Accelerator::software);
    const Geometry64& geometry = mesh.geometry();
    bool found = false;
    geometry.visit(bounds.slabs(bounds.max_radius(geometry.bounds())), -unlimited, unlimited,
                   [&](const ActiveTriangle& triangle) {
                       const TriangleBound seen = bounds.bound(triangle.vertices64());
                       found = seen.margin >= -seen.radius && seen.t_low <= 0 && seen.t_high > 0;
                       return !found;
                   });
    return found;
}

}  // namespace

InsideRays::InsideRays(const ClosedMesh& mesh, Aim aim, std::uint64_t seed, std::size_t origins)
    : mesh_(mesh), aim_(aim), seed_(seed), origins_(mesh.points_inside(origins, seed)) {}

Ray InsideRays::ray(std::uint64_t index) const {
    Draws draws(seed_, index);
    const vec3 origin = origins_[draws.below(origins_.size())];
    const Geometry64& geometry = mesh_.geometry();
    uint primitive = draws.below(geometry.triangle_count());
    while (!geometry.find(primitive)) primitive = (primitive + 1) % static_cast<uint>(geometry.triangle_count());
    const Triangle64 vertices = geometry.find(primitive)->vertices64();
    const uint vertex = draws.below(3);
    const bool at_vertex = aim_ == Aim::vertices || (aim_ == Aim::both && index % 2 == 0);
    const double w = at_vertex ? 0 : draws.unit();
    const dvec3 target = (1 - w) * vertices[vertex] + w * vertices[(vertex + 1) % 3];
    return {origin, 0, vec3(normalize(target - dvec3(origin))), std::numeric_limits<float>::infinity()};
}

std::vector<Ray> InsideRays::rays(std::uint64_t first, std::size_t count) const {
    std::vector<Ray> made(count);
    parallel_for(count, [&](std::size_t i) { made[i] = ray(first + i); });
    return made;
}

Parity check_crossings(const ClosedMesh& mesh, const Ray& ray, std::size_t counted) {
    if (counted % 2 == 1) return Parity::odd;
    if (is_undecided_at_origin(mesh, ray)) return Parity::unspecified;
    const dvec3 direction(ray.direction);
    Draws draws(counted, 0);
    const dvec3 turned = direction + 0x1p-40 * length(direction) * draws.direction();
    return counted < mesh.crossings(ray.origin, turned) ? Parity::leak : Parity::double_hit;
}

}  // namespace twinray
