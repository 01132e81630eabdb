// SPDX-License-Identifier: MIT
#include "validation/reference/error_bounds.h"

#include <algorithm>

#include "validation/reference/point_distance.h"

namespace twinray {
namespace {

constexpr double rounding32 = 16 * 0x1p-24, rounding64 = 32 * 0x1p-53;

dvec3 absolute_product(const glm::dmat3& m, const dvec3& v) {
    return abs(m[0]) * std::abs(v.x) + abs(m[1]) * std::abs(v.y) + abs(m[2]) * std::abs(v.z);
}

// Returns a positive margin inside, a negative one outside; a triangle seen edge-on has no inside.
double margin_of(const std::array<dvec2, 3>& vertices) {
    double distance = INFINITY;
    bool any_negative = false, any_positive = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec2& a = vertices[i];
        const dvec2& b = vertices[(i + 1) % 3];
        const double side = cross2(a, b);
        any_negative |= side < 0;
        any_positive |= side > 0;
        distance = std::min(distance, distance_to_segment(a, b, dvec2(0)));
    }
    return any_negative != any_positive ? distance : -distance;
}

// The effect of slope and thinness on depths.
struct Plane {
    double determinant;  // twice the projected area, signed
    dvec2 gradient;      // of depth
};

Plane plane_of(const std::array<dvec2, 3>& vertices, const std::array<double, 3>& z) {
    const dvec2 a = vertices[1] - vertices[0];
    const dvec2 b = vertices[2] - vertices[0];
    const double za = z[1] - z[0];
    const double zb = z[2] - z[0];
    const double determinant = cross2(a, b);
    return {determinant, dvec2(za * b.y - zb * a.y, a.x * zb - b.x * za) / determinant};
}

}  // namespace

double TriangleBound::distance_to(double u, double v) const {
    return length((1 - u - v) * vertices[0] + u * vertices[1] + v * vertices[2]);
}

ErrorBounds::ErrorBounds(const Ray& ray, const Placement64& placement, Accelerator accelerator)
    : rounding_(accelerator == Accelerator::reference ? rounding64 : rounding32),
      has_accurate_weights_(accelerator == Accelerator::software) {
    const dvec3 origin(ray.origin);
    const dvec3 direction(ray.direction);
    origin_ = placement.point_to_object(origin);
    direction_ = placement.vector_to_object(direction);
    length_ = length(direction_);
    if (!placement.is_identity) {
        const double inverse_error = accelerator == Accelerator::software ? 1.0 : placement.condition;
        const dvec3 shift =
            absolute_product(placement.to_object, origin) + absolute_product(placement.to_object, placement.offset);
        origin_error_ = inverse_error * length(shift);
        direction_error_ = inverse_error * length(absolute_product(placement.to_object, direction)) / length_;
    }
    const dvec3 along = direction_ / length_;
    const dvec3 size = abs(along);
    const int shortest = size.x <= size.y && size.x <= size.z ? 0 : (size.y <= size.z ? 1 : 2);
    longest_ = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    dvec3 other(0.0);
    other[shortest] = 1;
    const dvec3 across = normalize(cross(along, other));
    frame_ = {across, cross(along, across), along};
}

double ErrorBounds::radius_at(double distance) const {
    return rounding_ * (distance + origin_error_ + distance * direction_error_);
}

double ErrorBounds::max_radius(const Box64& box) const {
    if (box.is_empty()) return 0;
    return radius_at(length(max(abs(box.corners[0] - origin_), abs(box.corners[1] - origin_))));
}

TriangleBound ErrorBounds::bound(const Triangle64& triangle) const {
    TriangleBound bound;
    Depths depths{{}, INFINITY, -INFINITY};
    double distance = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 p = triangle[i] - origin_;
        bound.vertices[i] = {dot(p, frame_[0]), dot(p, frame_[1])};
        depths.z[i] = dot(p, frame_[2]);
        const double z_sheared = p[longest_] / direction_[longest_] * length_;
        depths.low = std::min({depths.low, depths.z[i], z_sheared});
        depths.high = std::max({depths.high, depths.z[i], z_sheared});
        distance = std::max(distance, length(p));
    }
    bound.radius = radius_at(distance);
    bound.margin = margin_of(bound.vertices);
    set_depth_bounds(bound, depths);
    return bound;
}

void ErrorBounds::set_depth_bounds(TriangleBound& bound, const Depths& depths) const {
    const auto& vertices = bound.vertices;
    const Plane plane = plane_of(vertices, depths.z);
    const auto [nearest, farthest] =
        std::minmax_element(vertices.begin(), vertices.end(),
                            [](const dvec2& first, const dvec2& second) { return length(first) < length(second); });
    const double reach = length(*farthest);
    // Displaced vertices change each edge function by up to `edge_error` and the area by up to three of them. Where
    // that may swallow the area, rounding chooses the weights and only the vertices' depths bound t.
    const double edge_error = 2 * bound.radius * reach;
    const double area = std::abs(plane.determinant);
    const double least_area = std::max(0.0, area - 3 * edge_error);
    const double weight_error = edge_error / least_area;
    const double z = depths.z[static_cast<std::size_t>(nearest - vertices.begin())] - dot(plane.gradient, *nearest);
    const double depth = depths.high - depths.low;
    // SwTlas's weights are those of its displaced vertices (its edge functions are accurate to a rounding), so that it
    // meets their plane, whose slope differs by what displacements of two vertices change; others round the weights.
    const double slope = (length(plane.gradient) * area + 4 * bound.radius * depth) / least_area;
    const double moved = has_accurate_weights_ ? bound.radius * slope : weight_error * depth;
    const double spread = bound.radius + moved;
    double low = depths.low - bound.radius;
    double high = depths.high + bound.radius;
    bound.t = (depths.low * 0.5 + depths.high * 0.5) / length_;
    bound.point_error = INFINITY;
    if (std::isfinite(spread)) {
        low = std::max(low, z - spread);
        high = std::min(high, z + spread);
        bound.point_error = bound.radius + weight_error * 2 * reach;
    }
    if (std::isfinite(z)) {  // else seen exactly edge-on
        // A kernel that refines t in float64 reports the plane of an outside ray, which may lie beyond the vertices;
        // its roundings displace the ray by 2^-24 of the radius at most.
        const double refined_error = bound.radius * (1 + 0x1p-24 * length(plane.gradient));
        low = std::min(low, z - refined_error);
        high = std::max(high, z + refined_error);
        bound.t = z / length_;
    }
    bound.t_low = low / length_;
    bound.t_high = high / length_;
}

}  // namespace twinray
