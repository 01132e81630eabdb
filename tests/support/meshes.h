// SPDX-License-Identifier: MIT
// Small seeded meshes for tests.
#pragma once

#include <random>

#include "engine/core/error.h"
#include "engine/scene/mesh.h"

namespace twinray::test {

// n triangles with corners near random points of the unit cube.
inline Mesh random_triangles(std::size_t n, unsigned seed, float size = 0.1f) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto point = [&] { return vec3(unit(random), unit(random), unit(random)); };
    Mesh mesh;
    mesh.name = text("random ", n);
    for (std::size_t i = 0; i < n; ++i) {
        const vec3 center = point();
        for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(center + (point() - 0.5f) * size);
        const uint first = static_cast<uint>(3 * i);
        mesh.triangles.push_back(uvec3(first, first + 1, first + 2));
    }
    return mesh;
}

// n copies of one triangle: all centroids equal.
inline Mesh equal_triangles(std::size_t n) {
    Mesh mesh;
    mesh.name = "equal";
    mesh.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
    mesh.triangles.assign(n, uvec3(0, 1, 2));
    return mesh;
}

}  // namespace twinray::test
