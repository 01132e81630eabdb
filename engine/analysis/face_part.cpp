// SPDX-License-Identifier: MIT
#include "engine/analysis/face_part.h"

#include <algorithm>

namespace twinray {

FacePart part_of_face(const Polygon64& triangle, const Polygon64& part) {
    const dvec3 normal = triangle.area_vector();
    const auto weight = [&](const dvec3& point, std::size_t vertex) {
        const Polygon64 below(point, triangle.vertices[(vertex + 1) % 3], triangle.vertices[(vertex + 2) % 3]);
        return dot(below.area_vector(), normal) / dot(normal, normal);
    };
    FacePart result;
    for (std::size_t i = 0; i < 4; ++i) {
        const dvec3& point = part.vertices[std::min(i, part.count - 1)];
        result.corners[i] = vec2(static_cast<float>(weight(point, 1)), static_cast<float>(weight(point, 2)));
    }
    const Polygon64 first(part.vertices[0], part.vertices[1], part.vertices[2]);
    result.first = part.count == 3 ? 1.0f : static_cast<float>(first.area() / part.area());
    return result;
}

}  // namespace twinray
