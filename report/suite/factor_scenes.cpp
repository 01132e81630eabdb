// SPDX-License-Identifier: MIT
#include "report/suite/factor_scenes.h"

#include <cmath>
#include <numbers>

#include <twinray/geometry.h>
#include <twinray/scene.h>

namespace twinray::suite {

Scene scene_of(std::vector<Mesh> meshes, vec3 second_at) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = std::move(meshes);
    for (uint i = 0; i < scene.meshes.size(); ++i)
        scene.instances.push_back({"", i, i == 1 ? Transform::translation(second_at) : Transform{}});
    return scene;
}

Mesh seen_from_inside(Mesh mesh) {
    for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

Mesh square(float z, bool looks_up, uint n, float side) {
    Mesh mesh;
    for (uint y = 0; y <= n; ++y)
        for (uint x = 0; x <= n; ++x)
            mesh.positions.push_back(vec3(side * static_cast<float>(x) / static_cast<float>(n),
                                          side * static_cast<float>(y) / static_cast<float>(n), z));
    for (uint y = 0; y < n; ++y)
        for (uint x = 0; x < n; ++x) {
            const uint corner = y * (n + 1) + x;
            mesh.triangles.push_back({corner, corner + 1, corner + n + 2});
            mesh.triangles.push_back({corner, corner + n + 2, corner + n + 1});
        }
    return looks_up ? mesh : seen_from_inside(std::move(mesh));
}

Scene parallel_squares(float distance, uint n, float side) {
    return scene_of({square(0, true, n, side), square(distance, false, n, side)});
}

Scene perpendicular(float w, float h) {
    return scene_of(
        {make_quad(vec3(0), vec3(w, 0, 0), vec3(0, 1, 0)), make_quad(vec3(0), vec3(0, 1, 0), vec3(0, 0, h))});
}

Mesh disc(uint corners) {
    Mesh mesh;
    mesh.positions.push_back(vec3(0));
    for (uint i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        mesh.positions.push_back(vec3(std::cos(angle), std::sin(angle), 0));
        mesh.triangles.push_back({0, i + 1, i + 1 == corners ? 1 : i + 2});
    }
    return mesh;
}

Mesh cup(uint corners) {
    const uint rings = corners / 4;
    Mesh mesh;
    mesh.positions.push_back(vec3(0, 0, -1));
    for (uint ring = 1; ring <= rings; ++ring)
        for (uint i = 0; i < corners; ++i) {
            const double angle = 2 * std::numbers::pi * i / corners, up = std::numbers::pi / 2 * ring / rings;
            const double z = ring == rings ? 0 : -std::cos(up);
            mesh.positions.push_back(vec3(std::sin(up) * std::cos(angle), std::sin(up) * std::sin(angle), z));
        }
    const auto at = [&](uint ring, uint i) { return ring == 0 ? 0 : 1 + (ring - 1) * corners + i % corners; };
    for (uint ring = 0; ring < rings; ++ring)
        for (uint i = 0; i < corners; ++i) {
            mesh.triangles.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
            if (ring > 0) mesh.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
        }
    return mesh;
}

Mesh frame(float z, float margin, float side) {
    Mesh mesh;
    for (const auto& [low, high] : {std::pair(-margin, 1 + margin), std::pair((1 - side) / 2, (1 + side) / 2)})
        for (const vec3& corner : {vec3(low, low, z), vec3(high, low, z), vec3(high, high, z), vec3(low, high, z)})
            mesh.positions.push_back(corner);
    for (uint i = 0; i < 4; ++i) {
        const uint next = (i + 1) % 4;
        mesh.triangles.push_back({i, next, 4 + next});
        mesh.triangles.push_back({i, 4 + next, 4 + i});
    }
    return mesh;
}

}  // namespace twinray::suite
