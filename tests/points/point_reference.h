// SPDX-License-Identifier: MIT
// Distances and winding numbers by other methods than the engine's, over all triangles.
#pragma once

#include <vector>

#include "engine/collide/pair_class.h"
#include "engine/collide/triangle_set.h"

namespace twinray::test {

// A triangle in world space.
struct PlacedTriangle {
    WorldTriangle vertices;
    uint instance = 0, triangle = 0;
    bool is_mirrored = false;
};
std::vector<PlacedTriangle> placed_triangles(std::span<const MeshView> meshes, std::span<const MeshInstance> instances);

// Returns points that are uniform in the cube [-size, size]^3.
std::vector<dvec3> random_points(std::size_t count, float size, unsigned seed);

// Returns the distance by Voronoi regions (Ericson, "Real-Time Collision Detection", 2005, 5.1.5), in numbers of 113
// bits of mantissa; for triangles without area, the least of the distances from their edges.
long double distance(const dvec3& point, const WorldTriangle& triangle);

// Returns the sum of the solid angles of all triangles (van Oosterom and Strackee 1983) over 4 pi: the winding number
// of closed surfaces.
double solid_winding(const dvec3& point, std::span<const PlacedTriangle> triangles);

}  // namespace twinray::test
