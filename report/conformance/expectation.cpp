// SPDX-License-Identifier: MIT
#include "report/conformance/expectation.h"

#include <algorithm>
#include <cmath>

namespace twinray::conformance {
namespace {

constexpr double rounding = 32 * 0x1p-24;  // twice that of ErrorBounds

// A share of the lengths, far above what rounding moves a ray: whatever lies beyond it needs no closer look.
constexpr double near_ray = 0x1p-10;

bool may_touch(const dvec3& center, double radius, const dvec3& origin, const dvec3& direction) {
    const dvec3 to_center = center - origin;
    const dvec3 across = cross(to_center, direction);
    const double reach = radius + near_ray * (length(to_center) + length(origin) + radius);
    return dot(across, across) <= reach * reach * dot(direction, direction);
}

// The interval from where the ray enters a box to where it leaves it; empty (first > second) if it misses the box.
struct Stretch {
    double first, second;
};
Stretch stretch_in(const Bounds& box, const dvec3& origin, const dvec3& direction, double shrunk_by) {
    Stretch stretch{-INFINITY, INFINITY};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = box.lo[axis] + shrunk_by - origin[static_cast<int>(axis)];
        const double high = box.hi[axis] - shrunk_by - origin[static_cast<int>(axis)];
        const double along = direction[static_cast<int>(axis)];
        if (along == 0) {
            if (low > 0 || high < 0) return {1, 0};
            continue;
        }
        stretch.first = std::max(stretch.first, std::min(low / along, high / along));
        stretch.second = std::min(stretch.second, std::max(low / along, high / along));
    }
    return stretch;
}

dvec3 absolute_product(const glm::dmat3& m, const dvec3& v) {
    return abs(m[0]) * std::abs(v.x) + abs(m[1]) * std::abs(v.y) + abs(m[2]) * std::abs(v.z);
}

bool is_culled_by_opacity(const MetFlags& flags) {
    return (flags.ray & (is_opaque(flags) ? ray_culls_opaque : ray_culls_no_opaque)) != 0;
}

}  // namespace

bool is_opaque(const MetFlags& flags) {
    if (flags.ray & (ray_opaque | ray_no_opaque)) return (flags.ray & ray_opaque) != 0;
    constexpr VkGeometryInstanceFlagsKHR forced = VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR;
    if (flags.instance & (forced | VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR)) return (flags.instance & forced) != 0;
    return (flags.geometry & VK_GEOMETRY_OPAQUE_BIT_KHR) != 0;
}

bool is_front(const MetFlags& flags, bool sees_normal_side) {
    const bool is_turned = (flags.instance & VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR) != 0;
    return sees_normal_side != is_turned;
}

bool is_culled_triangle(const MetFlags& flags, bool sees_normal_side) {
    if ((flags.ray & ray_skips_triangles) || is_culled_by_opacity(flags)) return true;
    if (flags.instance & VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR) return false;
    return (flags.ray & (is_front(flags, sees_normal_side) ? ray_culls_front : ray_culls_back)) != 0;
}

bool is_culled_box(const MetFlags& flags) { return (flags.ray & ray_skips_boxes) || is_culled_by_opacity(flags); }

Expectation::PlacedGeometry Expectation::placed(const GeometryInput& geometry, const Transform& to_world) {
    PlacedGeometry placed;
    placed.flags = geometry.flags;
    placed.placement = Placement64(geometry.transform ? to_world * *geometry.transform : to_world, "instance");
    placed.is_mirrored = geometry.transform && determinant(*geometry.transform) < 0;
    placed.boxes = geometry.boxes;
    for (uint i = 0; i < geometry.triangles.size(); ++i) {
        const uvec3 corners = geometry.triangles[i];
        const std::array<vec3, 3> given = {geometry.positions[corners.x], geometry.positions[corners.y],
                                           geometry.positions[corners.z]};
        if (!has_area(given)) continue;
        Triangle triangle{i, {dvec3(given[0]), dvec3(given[1]), dvec3(given[2])}, {}, 0};
        triangle.center = (triangle.vertices[0] + triangle.vertices[1] + triangle.vertices[2]) / 3.0;
        for (const dvec3& vertex : triangle.vertices)
            triangle.radius = std::max(triangle.radius, length(vertex - triangle.center));
        placed.triangles.push_back(triangle);
    }
    return placed;
}

Expectation::Expectation(const SceneInput& scene) : instances_(scene.top.instances) {
    for (const InstanceInput& instance : instances_) {
        placements_.emplace_back(instance.to_world, "instance");
        std::vector<PlacedGeometry>& geometries = geometries_.emplace_back();
        if (instance.bottom == no_bottom) continue;
        for (const GeometryInput& geometry : scene.bottoms[instance.bottom].geometries)
            geometries.push_back(placed(geometry, instance.to_world));
    }
}

std::vector<Candidate> Expectation::candidates(const Shot& shot) const {
    std::vector<Candidate> found;
    for (uint i = 0; i < instances_.size(); ++i) {
        if ((instances_[i].mask & shot.cull_mask) == 0) continue;
        for (uint g = 0; g < geometries_[i].size(); ++g) {
            const Candidate candidate{.instance = i, .geometry = g};
            add_triangles(shot, candidate, geometries_[i][g], found);
            add_boxes(shot, candidate, geometries_[i][g], found);
        }
    }
    return found;
}

void Expectation::add_triangles(const Shot& shot, Candidate candidate, const PlacedGeometry& geometry,
                                std::vector<Candidate>& found) const {
    if (geometry.triangles.empty()) return;
    const MetFlags flags{geometry.flags, instances_[candidate.instance].flags, shot.flags};
    const dvec3 origin = geometry.placement.point_to_object(dvec3(shot.ray.origin));
    const dvec3 direction = geometry.placement.vector_to_object(dvec3(shot.ray.direction));
    const ErrorBounds bounds(shot.ray, geometry.placement, Accelerator::hardware);
    candidate.is_opaque = is_opaque(flags);
    candidate.is_offered_once = geometry.flags & VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
    for (const Triangle& triangle : geometry.triangles) {
        if (!may_touch(triangle.center, triangle.radius, origin, direction)) continue;
        const TriangleBound bound = bounds.bound(triangle.vertices);
        if (bound.margin < -bound.radius || bound.t_high <= shot.ray.t_min || bound.t_low >= shot.ray.t_max) continue;
        const auto& [a, b, c] = triangle.vertices;
        const bool sees_normal_side = (dot(cross(b - a, c - a), direction) < 0) != geometry.is_mirrored;
        candidate.is_sure =
            bound.margin > bound.radius && bound.t_low > shot.ray.t_min && bound.t_high < shot.ray.t_max;
        // If a triangle is seen edge-on within rounding, either side may be in front.
        const bool is_culled = is_culled_triangle(flags, sees_normal_side);
        if (is_culled && (candidate.is_sure || is_culled_triangle(flags, !sees_normal_side))) continue;
        candidate.is_sure = candidate.is_sure && !is_culled;
        candidate.primitive = triangle.primitive;
        candidate.is_front = is_front(flags, sees_normal_side);
        candidate.t_low = bound.t_low;
        candidate.t_high = bound.t_high;
        found.push_back(candidate);
    }
}

void Expectation::add_boxes(const Shot& shot, Candidate candidate, const PlacedGeometry& geometry,
                            std::vector<Candidate>& found) const {
    const MetFlags flags{geometry.flags, instances_[candidate.instance].flags, shot.flags};
    if (geometry.boxes.empty() || is_culled_box(flags)) return;
    const dvec3 origin = geometry.placement.point_to_object(dvec3(shot.ray.origin));
    const dvec3 direction = geometry.placement.vector_to_object(dvec3(shot.ray.direction));
    candidate.is_box = true;
    candidate.is_opaque = is_opaque(flags);
    for (uint i = 0; i < geometry.boxes.size(); ++i) {
        const Bounds& box = geometry.boxes[i];
        if (std::isnan(box.lo.x)) continue;
        const double size = length(dvec3(box.lo)) + length(dvec3(box.hi)) + length(origin);
        const Stretch sure = stretch_in(box, origin, direction, rounding * geometry.placement.condition * size);
        const Stretch whole = stretch_in(box, origin, direction, 0);
        candidate.primitive = i;
        candidate.is_sure = sure.first < sure.second && sure.second > shot.ray.t_min && sure.first < shot.ray.t_max;
        candidate.t_low = whole.first;
        candidate.t_high = whole.second;
        found.push_back(candidate);
    }
}

bool Expectation::is_on_ray(const Shot& shot, const Candidate& candidate, vec2 uv) const {
    const PlacedGeometry& geometry = geometries_[candidate.instance][candidate.geometry];
    const auto triangle = std::ranges::find(geometry.triangles, candidate.primitive, &Triangle::primitive);
    const ErrorBounds bounds(shot.ray, geometry.placement, Accelerator::hardware);
    const TriangleBound bound = bounds.bound(triangle->vertices);
    return bound.distance_to(uv.x, uv.y) <= bound.point_error;
}

bool Expectation::is_object_ray(const Shot& shot, uint instance, vec3 origin, vec3 direction) const {
    const Placement64& placement = placements_[instance];
    const dvec3 start(shot.ray.origin), along(shot.ray.direction);
    const dvec3 moved =
        absolute_product(placement.to_object, start) + absolute_product(placement.to_object, placement.offset);
    const dvec3 turned = absolute_product(placement.to_object, along);
    const double allowed = rounding * placement.condition;
    return length(dvec3(origin) - placement.point_to_object(start)) <= allowed * length(moved) &&
           length(dvec3(direction) - placement.vector_to_object(along)) <= allowed * length(turned);
}

}  // namespace twinray::conformance
