// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include <glm/mat4x4.hpp>

#include "engine/core/shader_bridge.h"

namespace twinray {

// An affine map, 3x4 row-major, the bytes of VkTransformMatrixKHR: point' = rows * (point, 1).
struct Transform {
    std::array<vec4, 3> rows = {vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)};

    static Transform translation(vec3 offset);
    static Transform scaling(vec3 factors);
    // The upper three rows of a column-major GLM matrix; the fourth row must be (0, 0, 0, 1).
    static Transform of(const glm::mat4& matrix);

    bool operator==(const Transform&) const = default;
};
static_assert(sizeof(Transform) == 48);

// Evaluated in float64, rounded once.
vec3 transform_point(const Transform& transform, vec3 point);
vec3 transform_vector(const Transform& transform, vec3 vector);

// a after b.
Transform operator*(const Transform& a, const Transform& b);

// Determinant of the linear part, in float64.
double determinant(const Transform& transform);

// Why the map cannot place an instance, "" if it can: an entry is not finite, the linear part is singular (a
// determinant of exactly 0), or the inverse exceeds float32.
std::string fault_of(const Transform& transform);

// The inverse, computed in float64 and rounded once. Throws Error, naming `object`, when there is a
// fault_of(transform).
Transform inverse(const Transform& transform, const char* object);

}  // namespace twinray
