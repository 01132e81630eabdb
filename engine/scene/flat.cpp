// SPDX-License-Identifier: MIT
#include "engine/scene/flat.h"

#include <algorithm>
#include <cmath>

#include <twinray/scene.h>

#include "engine/core/error.h"
#include "engine/scene/mesh.h"
#include "engine/scene/rig.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

using glm::dmat3;

// Returns the longest cross product of two columns: perpendicular to all of them if they lie in a plane.
glm::dvec3 normal_of_columns(const dmat3& columns) {
    glm::dvec3 longest(0);
    for (int i = 0; i < 3; ++i)
        if (const glm::dvec3 normal = glm::cross(columns[i], columns[(i + 1) % 3]);
            glm::length(normal) > glm::length(longest))
            longest = normal;
    return longest;
}

double longest_column(const dmat3& matrix) {
    return std::max({glm::length(matrix[0]), glm::length(matrix[1]), glm::length(matrix[2])});
}

// A product of nodes may be singular but for its rounding.
bool has_inverse(const glm::dmat4& matrix, const dmat3& linear, double rounding) {
    const double most = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    return std::abs(glm::determinant(linear)) > rounding * most && fault_of(transform_of(matrix)).empty();
}

dvec3 unit_of(const glm::dvec3& v) { return dvec3(v / glm::length(v)); }

// Returns one of v and -v, the same for both.
dvec3 canonical(const dvec3& v) {
    for (int i = 0; i < 3; ++i)
        if (v[i] != 0) return v[i] < 0 ? -v : v;
    return v;
}

template <class V>
void project_along(V& v, const dvec3& lost) {
    const dvec3 whole(v.x, v.y, v.z);
    const dvec3 left = whole - dot(whole, lost) * lost;
    for (int i = 0; i < 3; ++i) v[i] = static_cast<float>(left[i]);
}

}  // namespace

std::optional<FlatPlacement> flat_placement_of(const glm::dmat4& matrix, double rounding) {
    const dmat3 linear(matrix);
    const double extent = longest_column(linear);
    if (!std::isfinite(extent) || extent == 0 || has_inverse(matrix, linear, rounding)) return std::nullopt;
    const dmat3 in_extents = linear / extent;
    const glm::dvec3 lost = normal_of_columns(glm::transpose(in_extents)), normal = normal_of_columns(in_extents);
    if (glm::length(lost) <= rounding || glm::length(normal) <= rounding) return std::nullopt;
    const dvec3 direction = canonical(unit_of(lost));
    if (glm::length(in_extents * to_glm(direction)) > rounding_of_floats) return std::nullopt;
    return FlatPlacement{direction, unit_of(normal), extent};
}

glm::dmat4 thickened(const glm::dmat4& matrix, double thickness, double rounding) {
    const std::optional<FlatPlacement> flat = flat_placement_of(matrix, rounding);
    if (!flat) return matrix;
    const glm::dvec3 image = to_glm(flat->normal) * (flat->extent * thickness), lost = to_glm(flat->lost);
    const dmat3 added = glm::outerProduct(image, lost);
    const dmat3 linear(matrix);
    const double sign = glm::determinant(linear + added) < 0 ? -1 : 1;  // nothing is turned inside out
    glm::dmat4 thick = matrix;
    for (int i = 0; i < 3; ++i) thick[i] = glm::dvec4(linear[i] + sign * added[i], 0);
    return thick;
}

void flatten_positions(std::vector<vec3>& positions, const dvec3& lost) {
    for (vec3& position : positions) project_along(position, lost);
}

void flatten_normals(std::vector<vec3>& normals, const dvec3& lost) {
    for (vec3& normal : normals) normal = vec3(dot(dvec3(normal), lost) < 0 ? -lost : lost);
}

void flatten_tangents(std::vector<vec4>& tangents, const dvec3& lost) {
    for (vec4& tangent : tangents) {
        project_along(tangent, lost);
        const vec3 direction = vec3(unit_or_zero(dvec3(tangent.x, tangent.y, tangent.z)));
        tangent = vec4(direction.x, direction.y, direction.z, tangent.w);
    }
}

std::optional<Transform> flatten(Mesh& mesh, const Transform& transform) {
    glm::dmat4 matrix(1);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) matrix[column][row] = transform.rows[std::size_t(row)][column];
    const std::optional<FlatPlacement> flat = flat_placement_of(matrix, rounding_of_floats);
    if (!flat) return std::nullopt;
    flatten_positions(mesh.positions, flat->lost);
    flatten_normals(mesh.normals, flat->lost);
    flatten_tangents(mesh.tangents, flat->lost);
    return transform_of(thickened(matrix, 1, rounding_of_floats));
}

}  // namespace twinray
