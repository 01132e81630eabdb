// SPDX-License-Identifier: MIT
// The scene for which the tutorial builds a tree.
#pragma once

#include <random>

#include <twinray/geometry.h>

using namespace twinray;

// [scene]
// Small triangles in the square [0, 1]^2 of the plane z = 0, many in one corner.
inline Mesh make_scene(uint count, uint seed) {
    std::mt19937 random(seed);
    const auto number = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
    Mesh scene;
    scene.name = "triangles";
    for (uint i = 0; i < count; ++i) {
        const float reach = i % 3 == 0 ? 0.35f : 0.9f;
        const float x = reach * number() + 0.03f, y = reach * number() + 0.03f;
        for (int corner = 0; corner < 3; ++corner) {
            const float dx = 0.06f * (number() - 0.5f), dy = 0.06f * (number() - 0.5f);
            scene.positions.push_back({x + dx, y + dy, 0});
        }
        scene.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return scene;
}
// [/scene]
