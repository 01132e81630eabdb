// SPDX-License-Identifier: MIT
// The meshes of the cases of section W, and rays at their edges.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/core/ray.h"
#include "engine/scene/mesh.h"

namespace twinray::suite {

// Returns make_grid in units of its cells: n x n of them in the plane y = 0, corners at integers.
Mesh make_integer_grid(uint n);
// Returns the same with every corner moved by up to `jitter` cells along each axis.
Mesh make_jittered_grid(uint n, float jitter, std::uint64_t seed);

// Returns the closed surface of a box, cut along ascending planes x, y and z = const; vertices are shared.
Mesh make_cut_box(const std::array<std::vector<float>, 3>& planes);

// Returns an icosphere with vertices at random radii in [0.4, 1.2]: closed, with a silhouette at every spike.
Mesh make_spiky_ball(uint subdivisions, std::uint64_t seed);

// Triangles around one vertex, closed: flat, or a cone with slopes below 1, tilted by less than 0.2.
struct Fan {
    vec3 hub;
    uint valence;
};
Mesh make_fans(std::span<const Fan> fans, std::uint64_t seed);

// Turns each triangle over with probability 1/2.
Mesh with_random_winding(Mesh mesh, std::uint64_t seed);

// Returns a ray without an end.
Ray make_ray(const vec3& origin, const vec3& direction);

// Returns rays through corners of the grid's cells, points of cell edges and of their diagonals, in turns, from both
// sides. Every coordinate is a multiple of 1/8 below 128, so that the ray passes its target exactly, at t = 1, and no
// arithmetic rounds. Slanted rays come from up to 8 cells beside; the others go straight up or down, with x and z of
// the direction at 0.
std::vector<Ray> exact_grid_rays(uint n, bool slanted, std::size_t count, std::uint64_t seed);

}  // namespace twinray::suite
