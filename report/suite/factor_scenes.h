// SPDX-License-Identifier: MIT
// Meshes between which view factors are known.
#pragma once

#include <twinray/scene.h>

namespace twinray::suite {

// One instance of each; only the second is moved.
Scene scene_of(std::vector<Mesh> meshes, vec3 second_at = vec3(0));
Mesh seen_from_inside(Mesh mesh);

// A square at the height z over [0, side]^2, of n x n cells of two triangles each, that looks up or down.
Mesh square(float z, bool looks_up, uint n = 1, float side = 1);
// Squares that look at each other.
Scene parallel_squares(float distance, uint n = 1, float side = 1);
// Rectangles of w and h beside an edge of 1 in common, the first in the plane z = 0.
Scene perpendicular(float w, float h);

// A regular polygon on the circle of radius 1 about the z axis, that looks up.
Mesh disc(uint corners);
// Half of a sphere of radius 1 below z = 0, of corners x corners / 4 cells, that looks inwards.
Mesh cup(uint corners);
// The square [-margin, 1 + margin]^2 at the height z without the square of this side in its middle.
Mesh frame(float z, float margin, float side);

}  // namespace twinray::suite
