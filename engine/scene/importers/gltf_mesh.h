// SPDX-License-Identifier: MIT
// Meshes of glTF.
#pragma once

#include <twinray/scene.h>

#include "engine/scene/importers/gltf_file.h"
#include "engine/scene/importers/gltf_motion.h"

namespace twinray {

struct GltfMesh {
    Mesh mesh;                                // before morph targets and skin
    VertexMotion motion;                      // of its vertices
    std::vector<std::vector<uint>> variants;  // by variant of KHR_materials_variants, like Mesh::materials; or none
};

// One glTF mesh as one Mesh: the triangles of all its primitives in file order. Primitives without a material get the
// index after the last of `materials`, which are those of the file. Points and lines are skipped with a warning; the
// result may be empty. is_skinned: whether a node with a skin shows it.
GltfMesh read_gltf_mesh(GltfFile& file, std::size_t index, const std::vector<Material>& materials, bool is_skinned);

}  // namespace twinray
