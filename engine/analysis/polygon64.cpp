#include "engine/analysis/polygon64.h"

#include <algorithm>
#include <cmath>

namespace twinray {

dvec3 Polygon64::area_vector() const {
    dvec3 twice(0);
    for (std::size_t i = 2; i < count; ++i)
        twice += cross(vertices[i - 1] - vertices.front(), vertices[i] - vertices.front());
    return twice * 0.5;
}

double Polygon64::longest_edge() const {
    double longest = 0;
    for (std::size_t i = 0; i < count; ++i) longest = std::max(longest, length(after(i) - vertices[i]));
    return longest;
}

dvec3 Polygon64::center() const {
    dvec3 sum(0);
    for (const dvec3& point : points()) sum += point;
    return sum / static_cast<double>(count);
}

Polygon64 Polygon64::flipped() const {
    Polygon64 other = *this;
    std::reverse(other.vertices.begin(), other.vertices.begin() + static_cast<std::ptrdiff_t>(count));
    return other;
}

Extent extent_of(const Polygon64& polygon, const dvec3& axis) {
    Extent extent;
    for (const dvec3& point : polygon.points()) {
        const double along = dot(axis, point);
        extent = extent.with({along, along});
    }
    return extent;
}

PolygonBox box_of(const Polygon64& polygon) {
    PolygonBox box{polygon.vertices.front(), polygon.vertices.front()};
    for (const dvec3& point : polygon.points()) box = {min(box.low, point), max(box.high, point)};
    return box;
}

double rounding_of(double size) { return 16 * std::numeric_limits<double>::epsilon() * size; }

Polygon64 before(const Polygon64& polygon, const Polygon64& triangle, double rounding) {
    const dvec3 normal = normalize(triangle.area_vector());
    std::array<double, 4> distances = {};
    double highest = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const double distance = dot(normal, polygon.vertices[i] - triangle.vertices.front());
        distances[i] = std::abs(distance) <= rounding ? 0 : distance;
        highest = std::max(highest, distances[i]);
    }
    if (highest == 0) return {};
    Polygon64 left;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const double here = distances[i], next = distances[(i + 1) % polygon.count];
        if (here >= 0) left.add(polygon.vertices[i]);
        if ((here > 0 && next < 0) || (here < 0 && next > 0)) {
            const double along = here / (here - next);
            left.add(polygon.vertices[i] * (1 - along) + polygon.after(i) * along);
        }
    }
    return left;
}

FacingPair facing_parts(const Polygon64& a, const Polygon64& b, double rounding) {
    return {before(a, b, rounding), before(b, a, rounding)};
}

double height_before(const Polygon64& polygon, const Polygon64& other) {
    const dvec3 normal = normalize(other.area_vector());
    return extent_of(polygon, normal).high - dot(normal, other.vertices.front());
}

double gap_over_size(const Polygon64& a, const Polygon64& b) {
    double gap = 0;
    for (const dvec3& axis : {a.area_vector(), b.area_vector(), b.center() - a.center()}) {
        const double size = length(axis);
        if (size == 0) continue;
        gap = std::max(gap, extent_of(a, axis / size).gap_to(extent_of(b, axis / size)));
    }
    return gap / std::max(a.longest_edge(), b.longest_edge());
}

namespace {

void add_edges(const Polygon64& polygon, std::vector<dvec3>& edges) {
    for (std::size_t i = 0; i < polygon.count; ++i) edges.push_back(polygon.after(i) - polygon.vertices[i]);
}

// Returns whether an edge of `one` separates it from `other`, in a plane with this normal; they may touch.
bool has_edge_between(const Polygon64& one, const Polygon64& other, const dvec3& normal, double rounding) {
    for (std::size_t i = 0; i < one.count; ++i) {
        const dvec3 across = normalize(cross(one.after(i) - one.vertices[i], normal));
        if (extent_of(one, across).gap_to(extent_of(other, across)) >= -rounding) return true;
    }
    return false;
}

}  // namespace

Shaft::Shaft(const FacingPair& pair, double rounding) : pair_(pair), rounding_(rounding) {
    const PolygonBox a = box_of(pair.a), b = box_of(pair.b);
    box_ = {min(a.low, b.low) - rounding, max(a.high, b.high) + rounding};
    add_edges(pair.a, edges_);
    add_edges(pair.b, edges_);
    const std::size_t own = edges_.size();
    edges_.reserve(own + pair.a.count * pair.b.count);
    axes_.reserve(2 + own * pair.a.count * pair.b.count);
    for (const dvec3& from : pair.a.points())
        for (const dvec3& to : pair.b.points()) edges_.push_back(to - from);
    add_axis(pair.a.area_vector());
    add_axis(pair.b.area_vector());
    for (std::size_t i = 0; i < own; ++i)
        for (std::size_t j = own; j < edges_.size(); ++j) add_axis(cross(edges_[i], edges_[j]));
}

// Returns nothing for a direction of 0.
std::optional<Shaft::Axis> Shaft::axis_along(const dvec3& direction) const {
    const double size = length(direction);
    if (!(size > 0)) return std::nullopt;
    const dvec3 unit = direction / size;
    return Axis{unit, extent_of(pair_.a, unit), extent_of(pair_.b, unit)};
}

void Shaft::add_axis(const dvec3& direction) {
    if (const std::optional<Axis> axis = axis_along(direction)) axes_.push_back(*axis);
}

// Returns whether an axis separates it: strictly, or touching; but a face in the plane of a polygon must be beside it.
bool Shaft::is_apart(const Polygon64& face, const Axis& axis) const {
    const Extent of_face = extent_of(face, axis.unit);
    const double gap = of_face.gap_to(axis.a.with(axis.b));
    if (gap > rounding_) return true;
    if (gap < -rounding_) return false;
    const auto covers = [&](const Polygon64& polygon, const Extent& extent) {
        return extent.with(of_face).length() <= rounding_ && !has_edge_between(polygon, face, axis.unit, rounding_) &&
               !has_edge_between(face, polygon, axis.unit, rounding_);
    };
    return !covers(pair_.a, axis.a) && !covers(pair_.b, axis.b);
}

bool Shaft::may_be_blocked_by(const Polygon64& face, const PolygonBox& box_of_face) const {
    for (int axis = 0; axis < 3; ++axis)
        if (box_of_face.low[axis] > box_.high[axis] || box_of_face.high[axis] < box_.low[axis]) return false;
    const auto parts = [&](const std::optional<Axis>& axis) { return axis && is_apart(face, *axis); };
    if (parts(axes_[0]) || parts(axes_[1]) || parts(axis_along(face.area_vector()))) return false;
    if (std::any_of(axes_.begin() + 2, axes_.end(), parts)) return false;
    for (std::size_t i = 0; i < face.count; ++i)
        for (const dvec3& edge : edges_)
            if (parts(axis_along(cross(face.after(i) - face.vertices[i], edge)))) return false;
    return true;
}

}  // namespace twinray
