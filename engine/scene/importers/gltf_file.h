// SPDX-License-Identifier: MIT
// An open glTF file: container, JSON and buffers, before anything is made from them.
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
    // "animations" and "skins": tinygltf does not get them, so that faults of unused ones do not matter.
    std::shared_ptr<const nlohmann::json> motion;
    std::vector<std::string> warnings;
    // How many elements accessors without a bufferView may still have, over all reads: no bytes account for them.
    mutable std::size_t zeros_left = 0;

    template <class... Parts>
    [[noreturn]] void fail(const Parts&... parts) const {
        throw Error(text("'", path.string(), "': ", parts...));
    }

    // Returns the text of an error of fail(), without the file's name, which begins it.
    std::string fault_of(const Error& error) const {
        const std::string message = error.what(), prefix = text("'", path.string(), "': ");
        return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
    }

    // Says each sentence once, however many objects it is true of.
    void warn(const std::string& sentence) {
        if (std::ranges::find(warnings, sentence) == warnings.end()) warnings.push_back(sentence);
    }
};

// Reads the file and all its buffers. Throws Error naming the file if it is not glTF 2.0, or has a damaged container or
// JSON, an unsupported required extension, or a missing or short buffer.
GltfFile open_gltf(const std::filesystem::path& path);

// Returns a buffer view's bytes; throws Error naming `object`, the range and the buffer's size if it exceeds that.
std::span<const std::uint8_t> view_bytes(const GltfFile& file, int view, const std::string& object);

// Reads the target of a URI: the data after "data:...;base64," or the file beside the glTF. Throws Error.
Bytes read_uri(const GltfFile& file, const std::string& uri);

// "node 3 'wheel'": the name of an object of a file in errors.
std::string gltf_name(const char* kind, std::size_t index, const std::string& name);

// Read extension objects, which tinygltf leaves untyped; missing members and those of another type give the fallback.
const tinygltf::Value* find_member(const tinygltf::Value& object, const std::string& key);
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name);
double number_or(const tinygltf::Value& object, const std::string& key, double fallback);
int index_of(const tinygltf::Value& object, const std::string& key);  // -1 when absent
std::vector<double> numbers_of(const tinygltf::Value& object, const std::string& key);

}  // namespace twinray
