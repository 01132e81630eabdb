// SPDX-License-Identifier: MIT
// Placements that lose one direction, as a scale of 1 1 0 does: they have no inverse, yet triangles keep an area.
#pragma once

#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include <twinray/geometry.h>

namespace twinray {

// The coordinates that remain of a placement without an inverse.
struct FlatPlacement {
    dvec3 lost;     // the direction that it maps to nothing, unit, in the mesh's space; one of the two is chosen
    dvec3 normal;   // of the plane that it maps to, unit
    double extent;  // the length of the longest image of a unit axis
};
// The distance by which rounding moves the entries of a placement, in its extents: in products of float64, in float32.
inline constexpr double rounding_of_products = 0x1p-40, rounding_of_floats = 0x1p-22;
// Returns nothing for a placement that has an inverse in float32, and for one that loses more than one direction. A
// determinant that differs from 0 by no more than `rounding` explains counts as 0.
std::optional<FlatPlacement> flat_placement_of(const glm::dmat4& matrix, double rounding = rounding_of_products);

// Returns the placement with an inverse: the lost direction is mapped to the normal times the extent times `thickness`.
// Parts that are flat along the lost direction stay as they are.
glm::dmat4 thickened(const glm::dmat4& matrix, double thickness, double rounding = rounding_of_products);

// Projects positions onto the plane through 0 that is perpendicular to `lost`.
void flatten_positions(std::vector<vec3>& positions, const dvec3& lost);
// Turns normals along `lost`, on the side on which they were; those of neither side point along `lost`.
void flatten_normals(std::vector<vec3>& normals, const dvec3& lost);
// Projects tangents into the plane, with length 1; 0 if they have no direction in it.
void flatten_tangents(std::vector<vec4>& tangents, const dvec3& lost);

}  // namespace twinray
