// EXT_meshopt_compression and KHR_meshopt_compression: buffer views that libmeshoptimizer decodes.
// KHR_draco_mesh_compression: primitives whose indices and attributes libdraco decodes.
#include <cstring>
#include <set>

#include "engine/scene/importers/gltf_json.h"

#ifdef TWINRAY_HAS_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef TWINRAY_HAS_DRACO
#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#endif

namespace twinray {
namespace {

using nlohmann::json;

constexpr const char* meshopt_names[] = {"KHR_meshopt_compression", "EXT_meshopt_compression"};

// The extension of a buffer or a view and its name; null: it has neither.
struct FoundMeshopt {
    const json* extension = nullptr;
    const char* name = "";
};

FoundMeshopt find_meshopt(const json& object) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return {};
    for (const char* name : meshopt_names)
        if (const auto extension = extensions->find(name); extension != extensions->end() && extension->is_object())
            return {&*extension, name};
    return {};
}

#ifdef TWINRAY_HAS_MESHOPT

// The contents of a view's extension, checked against the requirements of libmeshoptimizer.
struct MeshoptStream {
    std::span<const std::uint8_t> bytes;
    std::size_t count = 0, stride = 0;
    std::string mode, filter;
};

// No stream holds more: a byte of control says of 256 vertices that 4 bytes of each are 0.
constexpr std::size_t most_meshopt_expansion = 1024;

MeshoptStream read_meshopt_stream(const GltfFile& file, const json& extension,
                                  const std::vector<tinygltf::Buffer>& buffers, const std::string& object) {
    const std::span<const std::uint8_t> bytes = stream_bytes(file, extension, buffers, object);
    const auto count = json_count(extension, "count"), stride = json_count(extension, "byteStride");
    if (!count || !stride) file.fail(object, ": count or byteStride is missing or not a non-negative integer");
    MeshoptStream stream{bytes, *count, *stride, "", ""};
    stream.mode = json_string(extension, "mode");
    stream.filter = json_string(extension, "filter");
    if (stream.stride == 0 || stream.stride > 256 ||
        stream.count > most_meshopt_expansion * (bytes.size() + 1) / stream.stride)
        file.fail(object, ": ", stream.count, " elements of ", stream.stride, " bytes are no more than 256 each and ",
                  most_meshopt_expansion, " times the ", bytes.size(), " bytes of the stream");
    return stream;
}

bool meshopt_filter_fits(const MeshoptStream& stream) {
    if (stream.filter.empty() || stream.filter == "NONE") return true;
    if (stream.filter == "OCTAHEDRAL") return stream.stride == 4 || stream.stride == 8;
    if (stream.filter == "QUATERNION") return stream.stride == 8;
    return stream.filter == "EXPONENTIAL" && stream.stride % 4 == 0;
}

void undo_meshopt_filter(const MeshoptStream& stream, Bytes& bytes) {
    if (stream.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), stream.count, stream.stride);
    if (stream.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), stream.count, stream.stride);
    if (stream.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), stream.count, stream.stride);
}

constexpr const char* meshopt_remedy = "undo the compression with `gltfpack -noq -kn -km -i in.glb -o out.glb`";

// Returns 0 if it has decoded the stream.
int decode_meshopt_into(const MeshoptStream& stream, Bytes& bytes) {
    const auto* data = stream.bytes.data();
    const std::size_t size = stream.bytes.size();
    if (stream.mode == "ATTRIBUTES")
        return meshopt_decodeVertexBuffer(bytes.data(), stream.count, stream.stride, data, size);
    if (stream.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(bytes.data(), stream.count, stream.stride, data, size);
    return meshopt_decodeIndexSequence(bytes.data(), stream.count, stream.stride, data, size);
}

Bytes decode_meshopt(const GltfFile& file, const MeshoptStream& stream, const std::string& object) {
    const bool is_index = stream.mode == "TRIANGLES" || stream.mode == "INDICES";
    if (!is_index && stream.mode != "ATTRIBUTES")
        file.fail(object, ": unknown mode '", stream.mode, "'; ", meshopt_remedy);
    const bool fits = is_index ? stream.stride == 2 || stream.stride == 4 : stream.stride % 4 == 0;
    if (!fits || (stream.mode == "TRIANGLES" && stream.count % 3 != 0))
        file.fail(object, ": mode ", stream.mode, " with ", stream.count, " elements of ", stream.stride, " bytes");
    if (!meshopt_filter_fits(stream))
        file.fail(object, ": filter '", stream.filter, "' with a stride of ", stream.stride, " is not known; ",
                  meshopt_remedy);
    Bytes bytes(stream.count * stream.stride);
    const int status = decode_meshopt_into(stream, bytes);
    constexpr std::uint8_t newest_vertices = 0xa0;  // the newest that libmeshoptimizer of before 0.23 decodes
    if (status == -1 && MESHOPTIMIZER_VERSION < 230 && !is_index && !stream.bytes.empty() &&
        stream.bytes[0] > newest_vertices)
        file.fail(object, ": is compressed for a newer libmeshoptimizer than version ", MESHOPTIMIZER_VERSION / 1000,
                  ".", MESHOPTIMIZER_VERSION / 10 % 100, ", which this twinray was built with; ", meshopt_remedy);
    if (status != 0) file.fail(object, ": is damaged: libmeshoptimizer decodes it with status ", status);
    undo_meshopt_filter(stream, bytes);
    return bytes;
}

#endif

#ifdef TWINRAY_HAS_DRACO

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
        const auto put_values = [&](auto number) {
            put_draco_attribute<decltype(number)>(mesh_, *attribute, components, bytes);
        };
        if (!visit_component(json_count(target, "componentType").value_or(0), put_values))
            file_.fail(object_, ": ", name, " is neither float nor an integer of 8 or 16 bits");
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

#endif

}  // namespace

bool is_meshopt_placeholder(const json& buffer) { return find_meshopt(buffer).extension && !buffer.contains("uri"); }

void decode_meshopt_views([[maybe_unused]] const GltfFile& file, [[maybe_unused]] json& root,
                          [[maybe_unused]] std::vector<tinygltf::Buffer>& buffers) {
#ifdef TWINRAY_HAS_MESHOPT
    const std::size_t given = buffers.size();
    json& views = root["bufferViews"];
    for (std::size_t i = 0; views.is_array() && i < views.size(); ++i) {
        json& view = views[i];
        const FoundMeshopt found = find_meshopt(view);
        const auto target = json_count(view, "buffer");
        if (!found.extension || !target || *target >= given || !buffers[*target].data.empty()) continue;
        const std::string object = text("bufferView ", i, " ", found.name);
        tinygltf::Buffer decoded;
        decoded.data = decode_meshopt(file, read_meshopt_stream(file, *found.extension, buffers, object), object);
        view["buffer"] = buffers.size();
        view["byteOffset"] = 0;
        view["byteLength"] = decoded.data.size();
        buffers.push_back(std::move(decoded));
    }
#endif
}

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
