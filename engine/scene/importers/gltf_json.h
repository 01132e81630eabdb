// SPDX-License-Identifier: MIT
// The outer layers of a glTF file: GLB container and JSON, checked before tinygltf sees them.
#pragma once

#include <nlohmann/json.hpp>

#include "engine/scene/importers/gltf_file.h"

namespace twinray {

struct GltfJson {
    nlohmann::json root;
    Bytes binary;  // the BIN chunk of a .glb
};

// Splits the container and parses the JSON of `file.path`: an object that says it is glTF 2.x.
GltfJson read_gltf_json(const GltfFile& file);

// Throws Error naming the first extension without which the file cannot be shown, and what to do about it;
// warns of those it is shown without.
void check_extensions(GltfFile& file, const nlohmann::json& root);

// Throws Error naming the JSON path of the first member that is not of the type that glTF gives it.
void check_types(const GltfFile& file, const nlohmann::json& root);

// A string or a non-negative integer of an object, or the fallback where it is absent or of another type.
std::string json_string(const nlohmann::json& object, const char* key);
std::optional<std::uint64_t> json_count(const nlohmann::json& object, const char* key);

}  // namespace twinray
