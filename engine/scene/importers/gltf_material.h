// SPDX-License-Identifier: MIT
// Materials of glTF, with their layers KHR_materials_* and their textures.
#pragma once

#include <twinray/scene.h>

#include "engine/scene/importers/gltf_file.h"

namespace twinray {

// Fills scene.materials, one per glTF material in the same order, and scene.images with those that they use,
// each decoded once. An image that cannot be read becomes a checkerboard, with a warning;
// a normal map that cannot be read is left out.
void read_gltf_materials(GltfFile& file, Scene& scene);

}  // namespace twinray
