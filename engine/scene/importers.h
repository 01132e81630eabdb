// SPDX-License-Identifier: MIT
// The readers behind load_scene. What they return is not yet checked and completed; load_scene does that:
// triangles without a material have the index after the last one.
#pragma once

#include <filesystem>
#include <string>

#include "engine/scene/scene.h"

namespace twinray {

// .gltf and .glb, by tinygltf; told apart by their content.
Scene import_gltf(const std::filesystem::path& file);

// .ply.
Scene import_ply(const std::filesystem::path& file);

// .obj and .stl, by Assimp. `format` is the suffix without its dot and without .gz.
Scene import_assimp(const std::filesystem::path& file, const std::string& format);

}  // namespace twinray
