// An open glTF file: container, JSON and buffers, before anything is made from them.
//
// tinygltf turns the JSON into structs and does no more. The bytes of buffers and images are read here, because
// tinygltf fails a whole scene for one image, trusts image ranges, and explains a missing extension as a bad length.
#pragma once

#include <algorithm>

#include <nlohmann/json_fwd.hpp>
#include <tiny_gltf.h>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "twinray/glsl/cpp.h"

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

    // Returns an entry of a list. Throws Error naming `object` where an index of the file is beyond it.
    template <class List>
    auto& entry(List& list, int index, const std::string& object, const char* kind) const {
        if (index < 0 || std::size_t(index) >= list.size())
            fail(object, ": ", kind, " ", index, " does not exist; the file has ", list.size());
        return list[std::size_t(index)];
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

// Read accessors, with every byte range, type and sparse index checked before memory is touched.

// Calls visit(T{}) with the type T of a component. Returns false unless that is float or an integer of 8 or 16 bits.
template <class Visit>
bool visit_component(std::uint64_t type, const Visit& visit) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return visit(float{}), true;
        case TINYGLTF_COMPONENT_TYPE_BYTE: return visit(std::int8_t{}), true;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return visit(std::uint8_t{}), true;
        case TINYGLTF_COMPONENT_TYPE_SHORT: return visit(std::int16_t{}), true;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return visit(std::uint16_t{}), true;
        default: return false;
    }
}

// Reads all elements as floats, `components` per element. Normalised integers become [-1, 1] or [0, 1], others keep
// their value (KHR_mesh_quantization). 16 components are a matrix, column by column. `object` names the reader in
// errors: "mesh 2 'wheel' primitive 0 POSITION".
std::vector<float> read_floats(const GltfFile& file, int accessor, int components, const std::string& object);

// The same as vectors of N floats.
template <int N>
std::vector<Vec<N, float>> read_vectors(const GltfFile& file, int accessor, const std::string& object) {
    const std::vector<float> floats = read_floats(file, accessor, N, object);
    std::vector<Vec<N, float>> vectors(floats.size() / N);
    for (std::size_t i = 0; i < floats.size(); ++i) vectors[i / N][static_cast<int>(i % N)] = floats[i];
    return vectors;
}

// Reads unsigned scalars of 8, 16 or 32 bits.
std::vector<uint> read_indices(const GltfFile& file, int accessor, const std::string& object);

}  // namespace twinray
