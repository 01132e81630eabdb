// SPDX-License-Identifier: MIT
// KHR_draco_mesh_compression: primitives whose indices and attributes libdraco decodes.
#include "engine/scene/importers/gltf_json.h"

#ifdef TWINRAY_HAS_DRACO
#include <cstring>
#include <memory>
#include <set>

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#endif

namespace twinray {

using nlohmann::json;

#ifdef TWINRAY_HAS_DRACO
namespace {

constexpr const char* draco_extension = "KHR_draco_mesh_compression";

struct DracoCounts {
    std::uint32_t faces = 0, vertices = 0;
};

// Checks the header of the stream, before memory is allocated for a size that only a number claims. None: it is
// damaged.
std::optional<DracoCounts> draco_counts_of(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t header_size = 11;
    constexpr std::uint8_t sequential = 0;
    if (bytes.size() < header_size) return std::nullopt;
    const bool has_metadata = (bytes[10] & 0x80) != 0;
    if (has_metadata) return std::nullopt;
    draco::DecoderBuffer rest;
    rest.Init(reinterpret_cast<const char*>(bytes.data()) + header_size, bytes.size() - header_size);
    DracoCounts counts;
    const bool is_sequential = bytes[8] == sequential;
    if (!is_sequential) rest.Advance(1);  // the kind of traversal
    std::uint32_t first = 0, second = 0;
    if (!draco::DecodeVarint(&first, &rest) || !draco::DecodeVarint(&second, &rest)) return std::nullopt;
    return is_sequential ? DracoCounts{first, second} : DracoCounts{second, first};
}

std::unique_ptr<draco::Mesh> decode_draco(const GltfFile& file, std::span<const std::uint8_t> bytes,
                                          const std::string& object) {
    // A face of a flat grid takes less than a bit.
    constexpr std::size_t most_expansion = 64;
    const std::optional<DracoCounts> counts = draco_counts_of(bytes);
    if (!counts) file.fail(object, ": its stream of ", bytes.size(), " bytes has no header");
    if (std::max(counts->faces, counts->vertices) / most_expansion > bytes.size())
        file.fail(object, ": claims ", counts->faces, " faces and ", counts->vertices, " vertices, more than its ",
                  bytes.size(), " bytes can hold");
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) file.fail(object, ": libdraco cannot decode it: ", decoded.status().error_msg());
    return std::move(decoded).value();
}

template <class T>
void put_draco_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute, std::size_t components,
                         std::vector<unsigned char>& bytes) {
    bytes.resize(mesh.num_points() * components * sizeof(T));
    std::vector<T> values(components);
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
        attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(i)), static_cast<std::int8_t>(components),
                                  values.data());
        std::memcpy(bytes.data() + i * components * sizeof(T), values.data(), components * sizeof(T));
    }
}

// Numbers of components, by the type of vertex accessors.
std::size_t draco_components_of(const std::string& type) {
    if (type == "SCALAR") return 1;
    return type.size() == 4 && type.starts_with("VEC") && type[3] >= '2' && type[3] <= '4' ? std::size_t(type[3] - '0')
                                                                                           : 0;
}

// Puts the data of a stream where the accessors of its primitive find it.
class DracoPrimitive {
  public:
    DracoPrimitive(const GltfFile& file, json& root, std::vector<tinygltf::Buffer>& buffers, const draco::Mesh& mesh,
                   std::string object)
        : file_(file), root_(root), buffers_(buffers), mesh_(mesh), object_(std::move(object)) {}

    void put_indices(std::uint64_t accessor) {
        json& target = accessor_of(accessor, "indices", std::size_t{3} * mesh_.num_faces());
        target["componentType"] = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        std::vector<unsigned char> bytes(std::size_t{3} * mesh_.num_faces() * sizeof(std::uint32_t));
        for (std::uint32_t face = 0; face < mesh_.num_faces(); ++face)
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t index = mesh_.face(draco::FaceIndex(face))[i].value();
                std::memcpy(bytes.data() + (3 * face + i) * sizeof index, &index, sizeof index);
            }
        put(target, std::move(bytes));
    }

    void put_attribute(const std::string& name, std::uint64_t id, std::uint64_t accessor) {
        const draco::PointAttribute* attribute = mesh_.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        if (!attribute) file_.fail(object_, ": its stream has no attribute ", id, " for ", name);
        json& target = accessor_of(accessor, name, mesh_.num_points());
        const std::size_t components = draco_components_of(json_string(target, "type"));
        if (components == 0) file_.fail(object_, ": ", name, " is no scalar and no vector");
        std::vector<unsigned char> bytes;
        switch (json_count(target, "componentType").value_or(0)) {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                put_draco_attribute<std::int8_t>(mesh_, *attribute, components, bytes);
                break;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                put_draco_attribute<std::uint8_t>(mesh_, *attribute, components, bytes);
                break;
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                put_draco_attribute<std::int16_t>(mesh_, *attribute, components, bytes);
                break;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                put_draco_attribute<std::uint16_t>(mesh_, *attribute, components, bytes);
                break;
            case TINYGLTF_COMPONENT_TYPE_FLOAT: put_draco_attribute<float>(mesh_, *attribute, components, bytes); break;
            default: file_.fail(object_, ": ", name, " is neither float nor an integer of 8 or 16 bits");
        }
        put(target, std::move(bytes));
    }

  private:
    json& accessor_of(std::uint64_t index, const std::string& name, std::size_t count) {
        json& accessors = root_["accessors"];
        if (index >= accessors.size())
            file_.fail(object_, ": ", name, " names accessor ", index, "; the file has ", accessors.size());
        if (const auto given = json_count(accessors[index], "count"); given != count)
            file_.fail(object_, ": ", name, " has ", count, " elements in the stream, but its accessor ",
                       given.value_or(0));
        return accessors[index];
    }

    void put(json& accessor, std::vector<unsigned char>&& bytes) {
        accessor["bufferView"] = root_["bufferViews"].size();
        accessor["byteOffset"] = 0;
        root_["bufferViews"].push_back({{"buffer", buffers_.size()}, {"byteLength", bytes.size()}});
        tinygltf::Buffer buffer;
        buffer.data = std::move(bytes);
        buffers_.push_back(std::move(buffer));
    }

    const GltfFile& file_;
    json& root_;
    std::vector<tinygltf::Buffer>& buffers_;
    const draco::Mesh& mesh_;
    std::string object_;
};

std::span<const std::uint8_t> draco_stream(const GltfFile& file, const json& root, const json& extension,
                                           const std::vector<tinygltf::Buffer>& buffers, const std::string& object) {
    const std::uint64_t view = json_count(extension, "bufferView").value_or(UINT64_MAX);
    if (view >= root["bufferViews"].size())
        file.fail(object, ": its bufferView does not exist; the file has ", root["bufferViews"].size());
    return stream_bytes(file, root["bufferViews"][view], buffers, object);
}

// Returns whether the data are also uncompressed, as in files that do not require the extension; they are then used.
bool has_plain_data(const json& root, std::uint64_t accessor) {
    const auto accessors = root.find("accessors");
    return accessors != root.end() && accessor < accessors->size() && (*accessors)[accessor].contains("bufferView");
}

// Strips come out as triangles.
void decode_draco_primitive(const GltfFile& file, json& root, std::vector<tinygltf::Buffer>& buffers, json& primitive,
                            const std::string& object) {
    const json extension = primitive["extensions"][draco_extension];
    const std::unique_ptr<draco::Mesh> mesh =
        decode_draco(file, draco_stream(file, root, extension, buffers, object), object);
    DracoPrimitive decoded(file, root, buffers, *mesh, object);
    if (const auto indices = json_count(primitive, "indices")) decoded.put_indices(*indices);
    const json ids = extension.value("attributes", json::object());
    for (const auto& [name, id] : ids.items()) {
        const auto accessor = json_count(primitive["attributes"], name.c_str());
        if (!id.is_number_unsigned()) file.fail(object, ": attribute ", name, " is no index of the stream");
        if (accessor) decoded.put_attribute(name, id.get<std::uint64_t>(), *accessor);
    }
    primitive["mode"] = TINYGLTF_MODE_TRIANGLES;
}

}  // namespace
#endif

void decode_draco_primitives([[maybe_unused]] const GltfFile& file, [[maybe_unused]] json& root,
                             [[maybe_unused]] std::vector<tinygltf::Buffer>& buffers) {
#ifdef TWINRAY_HAS_DRACO
    if (!root.contains("meshes")) return;
    std::set<std::uint64_t> decoded;  // accessors of positions: a file may contain a mesh twice
    for (std::size_t m = 0; m < root["meshes"].size(); ++m) {
        json& mesh = root["meshes"][m];
        if (!mesh.contains("primitives")) continue;
        for (std::size_t p = 0; p < mesh["primitives"].size(); ++p) {
            json& primitive = mesh["primitives"][p];
            if (!has_extension(primitive, draco_extension) || !primitive.contains("attributes")) continue;
            const auto position = json_count(primitive["attributes"], "POSITION");
            if (!position || has_plain_data(root, *position) || !decoded.insert(*position).second) continue;
            decode_draco_primitive(
                file, root, buffers, primitive,
                text(gltf_name("mesh", m, json_string(mesh, "name")), " primitive ", p, " ", draco_extension));
        }
    }
#endif
}

}  // namespace twinray
