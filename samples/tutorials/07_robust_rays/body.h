// SPDX-License-Identifier: MIT
// A closed mesh, and rays from inside that are aimed at its vertices.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <twinray/geometry.h>

#include "twinray/glsl/vector_math.h"

using namespace twinray;

// [body]
// A sphere with dents: it is closed, and seen from its middle no part hides another.
inline Mesh make_body() {
    Mesh body = make_icosphere(4);
    body.name = "body";
    for (vec3& p : body.positions)
        p = p * (1 + 0.12f * std::sin(5 * p.x + 1) * std::sin(4 * p.y) + 0.08f * std::cos(7 * p.z + 2 * p.x));
    body.normals = smooth_normals(body);
    return body;
}

// [rays]
// Rays from points near the body's middle, and the vertices that they are aimed at.
struct AimedRays {
    std::vector<Ray> rays;
    std::vector<uint> vertices;
};

inline AimedRays aim_at_vertices(const Mesh& body, uint origins, uint seed) {
    std::mt19937 random(seed);
    const auto coordinate = [&] { return 0.4f * (static_cast<float>(random() >> 8) / 16777216.0f - 0.5f); };
    AimedRays aimed;
    for (uint i = 0; i < origins; ++i) {
        const float x = coordinate(), y = coordinate(), z = coordinate();
        const vec3 origin(x, y, z);
        for (uint vertex = 0; vertex < body.positions.size(); ++vertex) {
            aimed.rays.push_back(
                {.origin = origin, .t_min = 0, .direction = body.positions[vertex] - origin, .t_max = INFINITY});
            aimed.vertices.push_back(vertex);
        }
    }
    return aimed;
}
