// SPDX-License-Identifier: MIT

#include <cmath>

#include <twinray/geometry.h>

#include "engine/core/error.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/instance.h"
#include "twinray/glsl/cpp_end.h"

namespace {

using dmat3 = glm::dmat3;  // column-major: m[column][row]

dmat3 linear_part(const Transform& t) {
    dmat3 m;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) m[column][row] = t.rows[row][column];
    return m;
}

dvec3 offset(const Transform& t) { return {t.rows[0].w, t.rows[1].w, t.rows[2].w}; }

Transform rounded(const dmat3& linear, const dvec3& offset) {
    Transform t;
    for (int row = 0; row < 3; ++row) t.rows[row] = vec4(linear[0][row], linear[1][row], linear[2][row], offset[row]);
    return t;
}

Transform rounded_inverse(const Transform& t) {
    const dmat3 linear = glm::inverse(linear_part(t));
    return rounded(linear, -(linear * offset(t)));
}

}  // namespace

Transform Transform::translation(vec3 offset) {
    Transform t;
    for (int row = 0; row < 3; ++row) t.rows[row].w = offset[row];
    return t;
}

Transform Transform::scaling(vec3 factors) {
    Transform t;
    for (int row = 0; row < 3; ++row) t.rows[row][row] = factors[row];
    return t;
}

Transform Transform::of_columns(const std::array<vec4, 4>& columns) {
    const auto row = [&](int i) { return vec4(columns[0][i], columns[1][i], columns[2][i], columns[3][i]); };
    if (row(3) != vec4(0, 0, 0, 1)) fail("transform: the fourth row of the matrix must be 0 0 0 1");
    return {{row(0), row(1), row(2)}};
}

vec3 transform_point(const Transform& transform, vec3 point) {
    return vec3(linear_part(transform) * dvec3(point) + offset(transform));
}

vec3 transform_vector(const Transform& transform, vec3 vector) { return vec3(linear_part(transform) * dvec3(vector)); }

Transform operator*(const Transform& a, const Transform& b) {
    return rounded(linear_part(a) * linear_part(b), linear_part(a) * offset(b) + offset(a));
}

double determinant(const Transform& transform) { return glm::determinant(linear_part(transform)); }

std::string fault_of(const Transform& transform) {
    for (const vec4& row : transform.rows)
        for (int column = 0; column < 4; ++column)
            if (!std::isfinite(row[column])) return text("transform entry ", row[column], " is not finite");
    const double det = determinant(transform);
    if (det == 0.0) return "transform is singular (its determinant is 0)";
    // Kernels make the same test.
    const Rows to_world{transform.rows[0], transform.rows[1], transform.rows[2]};
    if (is_usable(to_world, inverse_of(to_world))) return "";
    return text("transform has no inverse in float32 without denormal numbers (its determinant is ", det, ")");
}

Transform inverse(const Transform& transform, const char* object) {
    if (const std::string fault = fault_of(transform); !fault.empty()) fail(object, ": ", fault);
    return rounded_inverse(transform);
}

}  // namespace twinray
