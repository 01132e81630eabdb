// SPDX-License-Identifier: MIT
// Meshes with known view factors.
#pragma once

#include <twinray/scene.h>

namespace twinray::suite {

// Makes one instance of each mesh; only the second is moved.
Scene scene_of(std::vector<Mesh> meshes, vec3 second_at = vec3(0));
Mesh seen_from_inside(Mesh mesh);

// Returns a square at the height z over [0, side]^2, of n x n cells of two triangles each, that faces up or down.
Mesh square(float z, bool looks_up, uint n = 1, float side = 1);
// Returns squares that face each other.
Scene parallel_squares(float distance, uint n = 1, float side = 1);
// Returns rectangles of w and h beside a common edge of 1, the first in the plane z = 0.
Scene perpendicular(float w, float h);

// Returns a regular polygon on the circle of radius 1 about the z axis, facing up.
Mesh disc(uint corners);
// Returns half of a sphere of radius 1 below z = 0, of corners x corners / 4 cells, facing inwards.
Mesh cup(uint corners);
// Returns the square [-margin, 1 + margin]^2 at the height z without the square of this side in its middle.
Mesh frame(float z, float margin, float side);

}  // namespace twinray::suite
