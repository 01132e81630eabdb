// SPDX-License-Identifier: MIT
// Scenes by name: generated ones, which anybody can measure again, and files; and a closed mesh with relief, of any
// size.
#pragma once

#include <string>

#include <twinray/scene.h>

#include "twinray/glsl/cpp.h"

namespace twinray::bench {

struct BenchScene {
    std::string name;
    Scene scene;
    Bounds framed;  // the box that the camera of primary rays sees
};

// "sphere:N": make_displaced_sphere of about N triangles.
// "soup:N": N separate random triangles in a cube, each about as large as its share of it.
// "instances:KxN": K instances of such a sphere of about N triangles, in a cube, turned and stretched at random, each
// about as large as its share of it.
// Anything else is a file for load_scene. Numbers may be written as 1e6. The same name gives the same bits everywhere.
// Throws Error naming what is not a number or out of range.
BenchScene make_scene(const std::string& name);

// Returns into how many parts edges of the icosahedron are cut, so that 20 frequency^2 is nearest to `triangles`.
uint geodesic_frequency(double triangles);

// Makes a geodesic sphere about the origin, displaced along its radius by five octaves of noise: radii of 0.75 to 1.25.
// It is closed: vertices are shared, triangles face outwards. Its bits are the same everywhere. `frequency` >= 1.
Mesh make_displaced_sphere(uint frequency);

// Returns how many triangles are built: those of all meshes, whatever the number of their instances.
std::size_t count_mesh_triangles(const Scene& scene);

}  // namespace twinray::bench
