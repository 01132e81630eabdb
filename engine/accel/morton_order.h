// Triangles in an order in which neighbours in space are near each other. Pure functions.
#pragma once

#include <span>
#include <vector>

#include "engine/scene/mesh.h"

namespace twinray {

// Returns positions of `centers` along a Morton curve with 2^21 steps over the largest extent; equal codes keep their
// order and non-finite centers go last, in order.
std::vector<uint> morton_order(std::span<const vec3> centers);

// Returns the centers of the triangles' boxes; NaN for a triangle with a non-finite vertex.
std::vector<vec3> triangle_centers(std::span<const vec3> positions, std::span<const uvec3> triangles);

}  // namespace twinray
