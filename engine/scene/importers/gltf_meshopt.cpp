// SPDX-License-Identifier: MIT
// EXT_meshopt_compression and KHR_meshopt_compression: buffer views that libmeshoptimizer decodes.
#include "engine/scene/importers/gltf_json.h"

#ifdef TWINRAY_HAS_MESHOPT
#include <meshoptimizer.h>
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

}  // namespace twinray
