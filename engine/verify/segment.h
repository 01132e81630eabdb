// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <glm/glm.hpp>

namespace twinray {

// Of a point to the segment from a to b, in the plane (glm::dvec2) or in space (glm::dvec3).
template <class Point>
double distance_to_segment(const Point& a, const Point& b, const Point& point) {
    const Point edge = b - a;
    const double square = glm::dot(edge, edge);
    const double along = square > 0 ? std::clamp(glm::dot(point - a, edge) / square, 0.0, 1.0) : 0.0;
    return glm::length(a + along * edge - point);
}

}  // namespace twinray
