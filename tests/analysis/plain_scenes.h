// SPDX-License-Identifier: MIT
// Scenes for which tests know what is seen.
#pragma once

#include <cmath>

#include <twinray/scene.h>

namespace twinray::test {

// Makes one instance of each mesh, or as many of the only mesh as there are transforms.
inline Scene scene_of(std::vector<Mesh> meshes, const std::vector<Transform>& transforms = {{}}) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = std::move(meshes);
    if (scene.meshes.size() == 1)
        for (const Transform& transform : transforms) scene.instances.push_back({"", 0, transform});
    else
        for (uint i = 0; i < scene.meshes.size(); ++i) scene.instances.push_back({"", i, transforms.front()});
    return scene;
}

// Makes a cube about `middle` with sides of 2, seen from inside, with each wall cut into n by n squares. It is turned
// about two axes and rounded to float32: walls miss their planes by that.
inline Scene rounded_room(uint n, double angle, const dvec3& middle = dvec3(0)) {
    const double c = std::cos(angle), s = std::sin(angle);
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const auto first = static_cast<uint>(mesh.positions.size());
            for (uint i = 0; i < (n + 1) * (n + 1); ++i) {
                dvec3 p(side);
                p[(axis + 1) % 3] = -1 + 2.0 * (i % (n + 1)) / n;
                p[(axis + 2) % 3] = -1 + 2.0 * (i / (n + 1)) / n;
                const dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
                mesh.positions.push_back(vec3(dvec3(q.x, c * q.y - s * q.z, s * q.y + c * q.z) + middle));
            }
            for (uint i = 0; i < n * n; ++i) {
                const uint at = first + i / n * (n + 1) + i % n, next = at + n + 1;
                for (const uvec3& t : {uvec3(at, at + 1, next + 1), uvec3(at, next + 1, next)})
                    mesh.triangles.push_back(side < 0 ? t : uvec3(t.x, t.z, t.y));
            }
        }
    return scene_of({mesh});
}

}  // namespace twinray::test
