// SPDX-License-Identifier: MIT
// Distances of points in float64.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace twinray {

// Returns twice the signed area of the triangle (0, a, b): positive where b is counterclockwise of a.
inline double cross2(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

// Returns the distance of a point to the segment from a to b, in the plane (dvec2) or in space (dvec3).
template <class Point>
double distance_to_segment(const Point& a, const Point& b, const Point& point) {
    const Point edge = b - a;
    const double square = dot(edge, edge);
    const double along = square > 0 ? std::clamp(dot(point - a, edge) / square, 0.0, 1.0) : 0.0;
    return length(a + along * edge - point);
}

// Returns the distance of a point to a triangle that has an area.
inline double distance_to_triangle(const std::array<dvec3, 3>& vertices, const dvec3& point) {
    const dvec3 normal = cross(vertices[1] - vertices[0], vertices[2] - vertices[0]);
    bool is_above = true;  // the triangle, along its normal
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 &a = vertices[i], &b = vertices[(i + 1) % 3];
        is_above = is_above && dot(cross(b - a, point - a), normal) >= 0;
        nearest = std::min(nearest, distance_to_segment(a, b, point));
    }
    return is_above ? std::abs(dot(point - vertices[0], normalize(normal))) : nearest;
}

}  // namespace twinray
