// SPDX-License-Identifier: MIT
// Makes meshes whose vertices are there twice.
#pragma once

#include "engine/scene/mesh.h"

namespace twinray::test {

// Returns the same triangles without normals, but with each vertex there twice: the first half of the triangles takes
// the copies. Files have such vertices at a seam of textures.
inline Mesh with_seam(Mesh mesh) {
    const auto copies = static_cast<uint>(mesh.positions.size());
    mesh.positions.reserve(2 * mesh.positions.size());
    for (uint i = 0; i < copies; ++i) mesh.positions.push_back(mesh.positions[i]);
    mesh.normals.clear();
    for (std::size_t i = 0; i < mesh.triangles.size() / 2; ++i) mesh.triangles[i] += uvec3(copies);
    return mesh;
}

}  // namespace twinray::test
