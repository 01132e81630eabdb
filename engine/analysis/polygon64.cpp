// SPDX-License-Identifier: MIT
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

}  // namespace twinray
