#include "report/conformance/expectation.h"

#include <algorithm>

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

// Returns the interval from where the ray enters a box to where it leaves it; empty if it misses the box.
Interval64 stretch_in(const Bounds& box, const dvec3& origin, const dvec3& direction, double shrunk_by) {
    Interval64 stretch;
    for (int axis = 0; axis < 3; ++axis) {
        const auto of_box = static_cast<std::size_t>(axis);
        const double low = box.lo[of_box] + shrunk_by - origin[axis], high = box.hi[of_box] - shrunk_by - origin[axis];
        if (direction[axis] == 0) {
            if (low > 0 || high < 0) return {1, 0};
            continue;
        }
        const double at_low = low / direction[axis], at_high = high / direction[axis];
        stretch = intersection(stretch, {std::min(at_low, at_high), std::max(at_low, at_high)});
    }
    return stretch;
}

bool is_culled_by_opacity(const MetFlags& flags) {
    return (flags.ray & (is_opaque(flags) ? ray_culls_opaque : ray_culls_no_opaque)) != 0;
}

constexpr std::array<std::string_view, finding_count> finding_names = {
    "AGREE",         "ROUNDING",     "LOST",       "LOST_NEARER",     "FALSE_HIT",   "WRONG_T",       "OUTSIDE_LIMITS",
    "WRONG_IDS",     "WRONG_FACING", "WRONG_UV",   "WRONG_TRANSFORM", "NOT_OFFERED", "OFFERED_AGAIN", "OFFERED_FALSELY",
    "WRONG_OPACITY", "LEAK",         "DOUBLE_HIT", "DIFFERS",         "BROKEN"};

// Returns the candidates that may be committed, and at which t.
std::vector<Candidate> committable(const Expectation& expectation, const Shot& shot) {
    std::vector<Candidate> all = expectation.candidates(shot);
    std::erase_if(all, [&](Candidate& candidate) {
        const bool is_out = is_refused(shot, candidate.primitive);
        if (!candidate.is_box) return is_out && !candidate.is_opaque;
        // A box is never committed by itself, whether it is opaque or not.
        const float t = box_t_of(shot, candidate.primitive);
        const bool is_inside = t >= shot.ray.t_min && t <= shot.ray.t_max;
        // If the box's t lies outside the box, an earlier hit may end the ray before the box comes up.
        candidate.is_sure = candidate.is_sure && t >= candidate.t_low && t <= candidate.t_high;
        candidate.t_low = candidate.t_high = t;
        return is_out || !is_inside;
    });
    return all;
}

bool is_named(const Candidate& candidate, const Answer& answer) {
    return candidate.is_box == (answer.kind == ANSWER_BOX) && candidate.instance == answer.instance &&
           candidate.geometry == answer.geometry && candidate.primitive == answer.primitive;
}

bool is_map_of(const Answer& answer, const Transform& to_world) {
    const vec3 columns[] = {answer.to_world.c0, answer.to_world.c1, answer.to_world.c2, answer.to_world.c3};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            if (columns[column][row] != to_world.rows[row][column]) return false;
    return true;
}

// Judges the other values of a hit on the right triangle.
Finding judge_attributes(const Expectation& expectation, const Shot& shot, const Answer& answer, const Candidate& hit) {
    const InstanceInput& instance = expectation.instance(answer.instance);
    if (answer.custom_index != instance.custom_index || answer.sbt_offset != instance.sbt_offset)
        return Finding::wrong_ids;
    if (!is_map_of(answer, instance.to_world) ||
        !expectation.is_object_ray(shot, answer.instance, answer.object_origin, answer.object_direction))
        return Finding::wrong_transform;
    if (hit.is_box) return Finding::agrees;
    if (hit.is_sure && hit.is_front != (answer.is_front != 0)) return Finding::wrong_facing;
    return expectation.is_on_ray(shot, hit, answer.uv) ? Finding::agrees : Finding::wrong_uv;
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
        const Interval64 sure = stretch_in(box, origin, direction, rounding * geometry.placement.condition * size);
        const Interval64 whole = stretch_in(box, origin, direction, 0);
        candidate.primitive = i;
        candidate.is_sure = sure.near < sure.far && sure.far > shot.ray.t_min && sure.near < shot.ray.t_max;
        candidate.t_low = whole.near;
        candidate.t_high = whole.far;
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

std::string_view name_of(Finding finding) { return finding_names[static_cast<std::size_t>(finding)]; }

Finding judge_hit(const Expectation& expectation, const Shot& shot, const Answer& answer) {
    const std::vector<Candidate> all = committable(expectation, shot);
    if (answer.kind == ANSWER_MISS) {
        if (std::ranges::any_of(all, &Candidate::is_sure)) return Finding::lost;
        return all.empty() ? Finding::agrees : Finding::rounding;
    }
    const auto hit = std::ranges::find_if(all, [&](const Candidate& c) { return is_named(c, answer); });
    if (hit == all.end()) return Finding::false_hit;
    const double t = static_cast<double>(answer.t);
    const bool is_inside =
        hit->is_box ? t >= shot.ray.t_min && t <= shot.ray.t_max : t > shot.ray.t_min && t < shot.ray.t_max;
    if (!is_inside) return Finding::outside_limits;
    // Reported values are rounded once more.
    const double slack = 0x1p-23 * std::abs(t);
    if (t < hit->t_low - slack || t > hit->t_high + slack) return Finding::wrong_t;
    const auto is_nearer = [&](const Candidate& c) { return c.is_sure && c.t_high < std::min(t, hit->t_low); };
    if (!(shot.flags & ray_terminates) && std::ranges::any_of(all, is_nearer)) return Finding::lost_nearer;
    const Finding attributes = judge_attributes(expectation, shot, answer, *hit);
    if (attributes != Finding::agrees) return attributes;
    return hit->is_sure ? Finding::agrees : Finding::rounding;
}

Finding judge_candidates(const Expectation& expectation, const Shot& shot, const Answer& answer,
                         std::span<const uint> offered) {
    const std::vector<Candidate> all = expectation.candidates(shot);
    // An opaque candidate is committed and ends the ray for everything beyond it.
    double end = INFINITY;
    for (const Candidate& candidate : all)
        if (candidate.is_opaque && !candidate.is_box) end = std::min(end, candidate.t_low);
    bool has_doubt = false;
    uint opaque_boxes = 0, other_boxes = 0;
    for (const Candidate& candidate : all) {
        if (!candidate.is_box && candidate.is_opaque) continue;
        const auto times = std::ranges::count(offered, candidate.name());
        const bool is_before_end = candidate.is_box ? candidate.t_low < end : candidate.t_high < end;
        if (candidate.is_sure && is_before_end && times == 0) return Finding::not_offered;
        if (candidate.is_offered_once && !candidate.is_box && times > 1) return Finding::offered_again;
        has_doubt = has_doubt || (!candidate.is_sure && !candidate.is_box);
        if (candidate.is_box) (candidate.is_opaque ? opaque_boxes : other_boxes) += static_cast<uint>(times);
    }
    const auto is_known = [&](uint name) {
        return std::ranges::any_of(all,
                                   [&](const Candidate& c) { return c.name() == name && (c.is_box || !c.is_opaque); });
    };
    if (!std::ranges::all_of(offered, is_known)) return Finding::offered_falsely;
    if (answer.boxes != opaque_boxes + other_boxes) return Finding::offered_falsely;
    if (answer.opaque_boxes != OPACITY_UNKNOWN && answer.opaque_boxes != opaque_boxes) return Finding::wrong_opacity;
    if (answer.outside > 0) return Finding::outside_limits;
    return has_doubt ? Finding::rounding : Finding::agrees;
}

}  // namespace twinray::conformance
