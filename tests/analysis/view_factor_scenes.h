// SPDX-License-Identifier: MIT
// Scenes whose view factors are known in closed form.
#pragma once

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "engine/analysis/pair_plan.h"
#include "tests/analysis/scenes.h"

namespace twinray::test {

struct KnownFactor {
    std::string name;
    Scene scene;
    double value;  // from mesh 0 to mesh 1
};

// Makes squares with sides of 1 that face each other at this distance.
inline Scene parallel_squares(float distance) {
    return scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                     make_quad(vec3(0, 0, distance), vec3(0, 1, 0), vec3(1, 0, 0))});
}

// Makes rectangles with a common edge of 1: the first w wide in the plane z = 0, the second h high.
inline Scene perpendicular_rectangles(float w, float h) {
    return scene_of(
        {make_quad(vec3(0), vec3(w, 0, 0), vec3(0, 1, 0)), make_quad(vec3(0), vec3(0, 1, 0), vec3(0, 0, h))});
}

// Turns a mesh so that it is seen from inside.
inline Mesh turned(Mesh mesh) {
    for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

// Makes a regular polygon of n vertices on a circle about the z axis, which looks up.
inline Mesh make_disc(int n, float radius) {
    Mesh mesh;
    mesh.positions.push_back(vec3(0));
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        mesh.positions.push_back(radius * vec3(std::cos(angle), std::sin(angle), 0));
        const auto first = static_cast<uint>(i + 1);
        mesh.triangles.push_back({0, first, i + 1 == n ? 1 : first + 1});
    }
    return mesh;
}

// Returns an entry of value 0 if there is none.
inline const ViewFactor& entry_of(const ViewFactorRow& row, uint target) {
    static const ViewFactor none;
    for (const ViewFactor& entry : row.factors)
        if (entry.target == target) return entry;
    return none;
}

// Returns A F in float64 from mesh 0 to mesh 1, if nothing is between them.
inline double contour_flow(const Scene& scene) {
    const FacePolygons polygons(scene);
    const auto first = static_cast<uint>(scene.meshes[0].triangles.size());
    std::vector<std::vector<uint>> meshes(2);
    for (uint face = 0; face < polygons.faces.size(); ++face) meshes[face < first ? 0 : 1].push_back(face);
    for (const PlannedPair& pair : plan_pairs(polygons, meshes, {}).pairs)
        if (pair.i == 0 && pair.j == 1) return pair.contour.flow;
    return 0;
}

// A long run takes more than CI has time for: TWINRAY_SEEDS=1000.
inline uint seeds() {
    const char* asked = std::getenv("TWINRAY_SEEDS");
    return asked ? static_cast<uint>(std::atoi(asked)) : 20;
}

}  // namespace twinray::test
