// SPDX-License-Identifier: MIT
#include "engine/scene/mesh.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/ray.h"

namespace twinray {
void Bounds::include(vec3 point) { lo = min(lo, point), hi = max(hi, point); }
void Bounds::include(const Bounds& other) { lo = min(lo, other.lo), hi = max(hi, other.hi); }
vec3 Bounds::size() const { return is_empty() ? vec3(0) : hi - lo; }
vec3 Bounds::center() const { return lo * 0.5f + hi * 0.5f; }

vec3 normal_or_none(const dvec3& normal) { return is_finite(vec3(normal)) ? vec3(normal) : vec3(0); }

Bounds bounds_of(const MeshView& mesh) {
    Bounds bounds;
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            if (const vec3 point = mesh.positions[triangle[corner]]; is_finite(point)) bounds.include(point);
    return bounds;
}

void check_indices(const MeshView& mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            if (const uint index = mesh.triangles[i][corner]; index >= mesh.positions.size())
                fail("mesh '", mesh.name, "': triangle ", i, " has vertex index ", index, ", but the mesh has only ",
                     mesh.positions.size(), " vertices");
}

std::size_t count_non_finite_triangles(const MeshView& mesh) {
    std::size_t count = 0;
    for (const uvec3& triangle : mesh.triangles)
        if (!is_finite(mesh.positions[triangle.x]) || !is_finite(mesh.positions[triangle.y]) ||
            !is_finite(mesh.positions[triangle.z]))
            ++count;
    return count;
}

dvec3 unit_or_zero(dvec3 v) {
    const double size = length(v);
    return size > 0 && std::isfinite(size) ? v / size : dvec3(0);
}

std::vector<vec3> smooth_normals(const MeshView& mesh) {
    check_indices(mesh);
    std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
    for (const uvec3& triangle : mesh.triangles) {
        const uint vertices[] = {triangle.x, triangle.y, triangle.z};
        dvec3 p[3];
        for (std::size_t k = 0; k < 3; ++k) p[k] = dvec3(mesh.positions[vertices[k]]);
        const dvec3 normal = unit_or_zero(cross(p[1] - p[0], p[2] - p[0]));
        for (std::size_t k = 0; k < 3; ++k) {
            const dvec3 to_next = p[(k + 1) % 3] - p[k], to_last = p[(k + 2) % 3] - p[k];
            if (normal != dvec3(0))
                sums[vertices[k]] += normal * std::atan2(length(cross(to_next, to_last)), dot(to_next, to_last));
        }
    }
    std::vector<vec3> normals;
    normals.reserve(sums.size());
    for (const dvec3& sum : sums) normals.push_back(vec3(unit_or_zero(sum)));
    return normals;
}

std::size_t count_undirected_normals(const Mesh& mesh) {
    return static_cast<std::size_t>(
        std::ranges::count_if(mesh.normals, [](vec3 normal) { return unit_or_zero(dvec3(normal)) == dvec3(0); }));
}

}  // namespace twinray
