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

// Returns whether a buffer holds nothing and only stands for the data that views with a meshopt extension decode to.
bool is_meshopt_placeholder(const nlohmann::json& buffer);

// Gives each buffer view that is compressed by meshopt, and has no data beside that, a buffer of its decoded data.
// Throws Error naming the view.
void decode_meshopt_views(const GltfFile& file, nlohmann::json& root, std::vector<tinygltf::Buffer>& buffers);

// Does the same with the data of primitives in KHR_draco_mesh_compression. Throws Error naming the primitive.
void decode_draco_primitives(const GltfFile& file, nlohmann::json& root, std::vector<tinygltf::Buffer>& buffers);

// Returns the bytes that an object with buffer, byteOffset and byteLength names; throws Error naming `object` where the
// buffer has fewer.
std::span<const std::uint8_t> stream_bytes(const GltfFile& file, const nlohmann::json& range,
                                           const std::vector<tinygltf::Buffer>& buffers, const std::string& object);

// Returns whether an object has the extension.
bool has_extension(const nlohmann::json& object, const char* name);

// Return a string or a non-negative integer of an object, or the fallback if it is absent or of another type.
std::string json_string(const nlohmann::json& object, const char* key);
std::optional<std::uint64_t> json_count(const nlohmann::json& object, const char* key);

}  // namespace twinray
