#include "engine/scene/importers/gltf_json.h"

#include <cstring>

#include "engine/core/json_input.h"

namespace twinray {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "GLB headers and buffers are read as they lie");

constexpr std::uint32_t CHUNK_JSON = 0x4e4f534a, CHUNK_BIN = 0x004e4942;

std::uint32_t word_at(const Bytes& bytes, std::size_t offset) {
    std::uint32_t word;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

constexpr const char* old_version_remedy = "convert it with `gltf-pipeline -i in.gltf -o out.gltf`";

// Returns the JSON.
std::string_view split_glb(const GltfFile& file, const Bytes& bytes, Bytes& binary) {
    if (bytes.size() < 20) file.fail("the GLB header is truncated (", bytes.size(), " of 20 bytes)");
    if (const std::uint32_t version = word_at(bytes, 4); version != 2)
        file.fail("is GLB version ", version, "; only glTF 2.0 is supported, ", old_version_remedy);
    const std::size_t length = word_at(bytes, 8);
    if (length > bytes.size()) file.fail("the GLB is truncated: ", bytes.size(), " of ", length, " bytes");

    std::string_view source;
    for (std::size_t offset = 12; offset + 8 <= length;) {
        const std::size_t size = word_at(bytes, offset), type = word_at(bytes, offset + 4);
        offset += 8;
        if (size > length - offset)
            file.fail("the GLB chunk at byte ", offset - 8, " has ", size, " bytes, but only ", length - offset,
                      " follow");
        const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(offset);
        if (type == CHUNK_JSON && source.empty())
            source = {reinterpret_cast<const char*>(bytes.data()) + offset, size};
        else if (type == CHUNK_BIN && binary.empty())
            binary.assign(first, first + static_cast<std::ptrdiff_t>(size));
        offset += size;
    }
    if (source.empty()) file.fail("the GLB has no JSON chunk");
    return source;
}

json parse(const GltfFile& file, std::string_view source) {
    try {
        return parse_json<json>(source);
    } catch (const json::exception& e) {
        file.fail("not valid JSON: ", e.what());
    } catch (const Error& e) {
        file.fail(e.what());
    }
}

void check_version(const GltfFile& file, const json& root) {
    const auto asset = root.find("asset");
    const std::string version = asset == root.end() ? std::string() : json_string(*asset, "version");
    if (version.starts_with("2.")) return;
    if (version.empty() && !root.contains("techniques"))
        file.fail("has no \"asset\": {\"version\": \"2.0\"}, so it is not glTF 2.0");
    file.fail("is glTF ", version.empty() ? "1.0" : version, "; only glTF 2.0 is supported, ", old_version_remedy);
}

// Checks the two lists that are read before check_types sees the rest.
void check_lists(const GltfFile& file, const json& root) {
    for (const char* key : {"buffers", "images"}) {
        const auto list = root.find(key);
        if (list == root.end()) continue;
        if (!list->is_array()) file.fail("JSON /", key, " is not a list of objects");
        for (std::size_t i = 0; i < list->size(); ++i)
            if (!(*list)[i].is_object()) file.fail("JSON /", key, "/", i, " is not an object");
    }
}

}  // namespace

std::string json_string(const json& object, const char* key) {
    const auto member = object.find(key);
    return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

std::optional<std::uint64_t> json_count(const json& object, const char* key) {
    const auto member = object.find(key);
    if (member == object.end() || !member->is_number_unsigned()) return std::nullopt;
    return member->get<std::uint64_t>();
}

GltfJson read_gltf_json(const GltfFile& file) {
    const Bytes bytes = read_file(file.path);
    const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    GltfJson result;
    result.root = parse(file, all.starts_with("glTF") ? split_glb(file, bytes, result.binary) : all);
    if (!result.root.is_object()) file.fail("the JSON is not an object");
    check_version(file, result.root);
    check_lists(file, result.root);
    return result;
}

}  // namespace twinray
