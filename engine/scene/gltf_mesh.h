// SPDX-License-Identifier: MIT
#pragma once

#include "engine/scene/gltf_file.h"
#include "engine/scene/mesh.h"

namespace twinray {

// One glTF mesh as one Mesh: the triangles of all its primitives in file order. Primitives without a material get
// `default_material`. Points and lines are skipped with a warning; the result may be empty.
Mesh read_gltf_mesh(GltfFile& file, std::size_t index, uint default_material);

}  // namespace twinray
