// SPDX-License-Identifier: MIT
// Scenes whose view factors are known in closed form.
#pragma once

#include "tests/analysis/scenes.h"

namespace twinray::test {

// Squares with sides of 1 that face each other at this distance.
inline Scene parallel_squares(float distance) {
    return scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                     make_quad(vec3(0, 0, distance), vec3(0, 1, 0), vec3(1, 0, 0))});
}

// Rectangles with an edge of 1 in common: the first w wide in the plane z = 0, the second h high.
inline Scene perpendicular_rectangles(float w, float h) {
    return scene_of(
        {make_quad(vec3(0), vec3(w, 0, 0), vec3(0, 1, 0)), make_quad(vec3(0), vec3(0, 1, 0), vec3(0, 0, h))});
}

// Seen from inside.
inline Mesh turned(Mesh mesh) {
    for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

}  // namespace twinray::test
