// SPDX-License-Identifier: MIT
// KHR_materials_variants.
#pragma once

#include <twinray/scene.h>

#include "engine/scene/importers/gltf_file.h"

namespace twinray {

// Names of the file's variants.
std::vector<std::string> read_variant_names(const GltfFile& file);

// Returns by variant the primitive's material, or -1 if it keeps its own; empty if it has no mapping. Throws Error
// naming `object` on a variant or material that does not exist.
std::vector<int> read_variant_materials(const GltfFile& file, const tinygltf::Primitive& primitive,
                                        const std::string& object);

}  // namespace twinray
