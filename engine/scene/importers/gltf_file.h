// SPDX-License-Identifier: MIT
// A glTF file opened: container, JSON and buffers, before anything is made of them.
//
// tinygltf turns the JSON into structs and does no more. The bytes of buffers and images are read here, because
// tinygltf fails a whole scene for one image, trusts image ranges, and explains a missing extension as a bad length.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <tiny_gltf.h>

#include "engine/core/error.h"
#include "engine/scene/bytes.h"

namespace twinray {

struct GltfFile {
    std::filesystem::path path;
    tinygltf::Model model;  // buffers hold their bytes; images hold name, uri, bufferView and mimeType, not pixels
    // "animations" and "skins": tinygltf is not given them, so that faults of those that nothing uses do not matter.
    std::shared_ptr<const nlohmann::json> motion;
    std::vector<std::string> warnings;
    // Elements that accessors without a bufferView may still have, of all reads of them: no bytes vouch for these.
    mutable std::size_t zeros_left = 0;

    template <class... Parts>
    [[noreturn]] void fail(const Parts&... parts) const {
        throw Error(text("'", path.string(), "': ", parts...));
    }

    // Says each sentence once, however many objects it is true of.
    void warn(const std::string& sentence) {
        if (std::ranges::find(warnings, sentence) == warnings.end()) warnings.push_back(sentence);
    }
};

// Reads the file and all its buffers. Throws Error naming the file on: not glTF 2.0, damaged container or JSON, a
// required extension that we lack, a missing or short buffer.
GltfFile open_gltf(const std::filesystem::path& path);

// The bytes of a buffer view; throws Error naming `object`, the range and the buffer's size when it leaves the buffer.
std::span<const std::uint8_t> view_bytes(const GltfFile& file, int view, const std::string& object);

// What a URI stands for: the data after "data:...;base64," or the file beside the glTF. Throws Error.
Bytes read_uri(const GltfFile& file, const std::string& uri);

// "node 3 'wheel'": how errors name the objects of a file.
std::string gltf_name(const char* kind, std::size_t index, const std::string& name);

// Reading extension objects, which tinygltf leaves untyped; what is missing or of another type gives the fallback.
const tinygltf::Value* find_member(const tinygltf::Value& object, const std::string& key);
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name);
double number_or(const tinygltf::Value& object, const std::string& key, double fallback);
int index_of(const tinygltf::Value& object, const std::string& key);  // -1 when absent
std::vector<double> numbers_of(const tinygltf::Value& object, const std::string& key);

}  // namespace twinray
