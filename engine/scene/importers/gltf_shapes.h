// SPDX-License-Identifier: MIT
// Meshes of glTF by the shape that skins and morph targets give them.
#pragma once

#include "engine/scene/importers/gltf_nodes.h"

namespace twinray {

// Reads each mesh that an instance places, once for each shape that skin and morph weights give it, in the rest pose,
// and with it scene.instances, scene.variants, rig.instances, rig.hidden and rig.meshes. Instances of meshes without
// triangles are dropped.
void read_gltf_shapes(GltfFile& file, std::vector<GltfInstance> instances, Scene& scene, Rig& rig);

}  // namespace twinray
