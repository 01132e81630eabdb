// SPDX-License-Identifier: MIT
// Layers of glTF materials: KHR_materials_*.
#pragma once

#include "engine/scene/importers/gltf_texture.h"

namespace twinray {

// Takes KHR_materials_{anisotropy, clearcoat, sheen, specular, volume} into `material`; other extensions are none of
// its business. `object` names the material in errors and warnings.
void read_gltf_layer(const std::string& name, const tinygltf::Value& extension, const std::string& object,
                     GltfTextures& textures, Material& material);

}  // namespace twinray
