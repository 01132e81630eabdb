// SPDX-License-Identifier: MIT
// Scenes by name: generated ones, which anybody can measure again, and files.
#pragma once

#include <string>

#include <twinray/scene.h>

namespace twinray::bench {

struct BenchScene {
    std::string name;
    Scene scene;
    Bounds framed;  // what the camera of primary rays sees
};

// "sphere:N": make_displaced_sphere of about N triangles.
// "soup:N": N separate random triangles in a cube, each about as large as its share of it.
// "instances:KxN": K instances of such a sphere of about N triangles, in a cube, turned and stretched at random, each
// about as large as its share of it.
// Anything else is a file for load_scene. Numbers may be written as 1e6. The same name gives the same bits everywhere.
// Throws Error naming what is not a number or out of range.
BenchScene make_scene(const std::string& name);

// Triangles of all meshes, whatever the number of their instances: what is built.
std::size_t count_mesh_triangles(const Scene& scene);

}  // namespace twinray::bench
