// SPDX-License-Identifier: MIT
// The data that move the nodes of a glTF file and their objects: morph weights, skins, animations.
#pragma once

#include "engine/scene/importers/gltf_nodes.h"

namespace twinray {

// Reads nodes with their morph weights, skins and animations. Skins have the file's indices; those that no shown node
// uses have no joints. Throws Error naming a node's weights or skin that cannot be used. For animations that cannot be
// played, Animation::fault and a warning say why.
Rig read_gltf_rig(GltfFile& file, const std::vector<GltfNode>& nodes);

// Read parts of it. flat: the index into `nodes` by the file's index of a node, -1 for one that is not shown.
Skin read_gltf_skin(const GltfFile& file, std::size_t index, const std::vector<std::int32_t>& flat);
std::vector<Animation> read_gltf_animations(GltfFile& file, const Rig& rig, const std::vector<std::int32_t>& flat);

}  // namespace twinray
