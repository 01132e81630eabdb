// SPDX-License-Identifier: MIT
// Scenes for tests that need no device.
#pragma once

#include "engine/scene/scene.h"

namespace twinray::test {

// One instance of each mesh.
inline Scene scene_of_meshes(std::vector<Mesh> meshes) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = std::move(meshes);
    for (uint i = 0; i < scene.meshes.size(); ++i) scene.instances.push_back({"", i, {}});
    return scene;
}

}  // namespace twinray::test
