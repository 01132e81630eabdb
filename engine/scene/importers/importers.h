// The readers behind load_scene(), which checks and completes their scenes: triangles without a material have the index
// after the last one. `origin`: the argument of load_scene().
#pragma once

#include <twinray/scene.h>

namespace twinray {

// Imports .gltf and .glb, by tinygltf; told apart by their content.
Scene import_gltf(const std::filesystem::path& file, const std::optional<dvec3>& origin);

// Imports .ply.
Scene import_ply(const std::filesystem::path& file, const std::optional<dvec3>& origin);

// Imports .obj, with the .mtl files and images that it names.
Scene import_obj(const std::filesystem::path& file, const std::optional<dvec3>& origin);

// Imports .stl, text and binary; told apart by their content.
Scene import_stl(const std::filesystem::path& file, const std::optional<dvec3>& origin);

}  // namespace twinray
