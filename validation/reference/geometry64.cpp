// SPDX-License-Identifier: MIT
#include "validation/reference/geometry64.h"

#include <algorithm>
#include <limits>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr uint inactive = std::numeric_limits<uint>::max();

double max_abs(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

Box64 box_of(const std::array<vec3, 3>& vertices) {
    Box64 box;
    for (const vec3& vertex : vertices) box.include(dvec3(vertex));
    return box;
}

std::array<vec3, 3> vertices_of(const MeshView& mesh, const uvec3& triangle) {
    return {mesh.positions[triangle.x], mesh.positions[triangle.y], mesh.positions[triangle.z]};
}

}  // namespace

ObjectRay::ObjectRay(const dvec3& origin, const dvec3& direction, double scale)
    : slabs(origin, direction, 0x1p-48 * (max_abs(origin) + scale)), sheared(origin, direction) {}

Triangle64 ActiveTriangle::vertices64() const { return {dvec3(vertices[0]), dvec3(vertices[1]), dvec3(vertices[2])}; }

std::optional<TriangleHit64> ActiveTriangle::intersect(const ObjectRay& ray, const Interval64& clip) const {
    const Interval64 inside = intersection(ray.slabs.clip(box_of(vertices)), clip);
    if (inside.is_empty()) return std::nullopt;
    std::optional<TriangleHit64> hit = ray.sheared.intersect(vertices64());
    if (hit) hit->t = std::clamp(hit->t, inside.near, inside.far);
    return hit;
}

Geometry64::Geometry64(const MeshView& mesh) : slots_(mesh.triangles.size(), inactive) {
    if (mesh.triangles.size() >= inactive)
        fail("mesh '", mesh.name, "': ", mesh.triangles.size(), " triangles, the limit is ", inactive - 1);
    check_indices(mesh);
    std::vector<ActiveTriangle> triangles;
    std::vector<Box64> boxes;
    for (uint primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
        const std::array<vec3, 3> vertices = vertices_of(mesh, mesh.triangles[primitive]);
        if (!has_area(vertices)) continue;
        triangles.push_back({vertices, primitive});
        boxes.push_back(box_of(vertices));
    }
    bvh_ = Bvh64(boxes);
    triangles_.reserve(triangles.size());
    for (const uint item : bvh_.order()) {
        slots_[triangles[item].primitive] = static_cast<uint>(triangles_.size());
        triangles_.push_back(triangles[item]);
    }
}

const ActiveTriangle* Geometry64::find(uint primitive) const {
    if (primitive >= slots_.size() || slots_[primitive] == inactive) return nullptr;
    return &triangles_[slots_[primitive]];
}

}  // namespace twinray
