#include "engine/scene/importers/gltf_file.h"

#include "engine/core/platform.h"
#include "engine/scene/importers/gltf_json.h"

namespace twinray {
namespace {

using nlohmann::json;

Bytes read_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        fail("data URI '", uri.substr(0, 40), "...' is not base64");
    std::optional<Bytes> bytes = decode_base64(uri.substr(comma + 1));
    if (!bytes) fail("data URI '", uri.substr(0, 40), "...' has characters foreign to base64");
    return std::move(*bytes);
}

Bytes read_buffer(const GltfFile& file, const json& buffer, std::size_t index, Bytes& binary) {
    const std::string name = gltf_name("buffer", index, json_string(buffer, "name"));
    const auto length = json_count(buffer, "byteLength");
    if (!length) file.fail(name, ": byteLength is missing or not a positive integer");
    const std::string uri = json_string(buffer, "uri");
    if (uri.empty() && index > 0) file.fail(name, ": has no uri, and only buffer 0 may be the binary chunk of a .glb");
    Bytes bytes;
    try {
        bytes = uri.empty() ? std::move(binary) : read_uri(file, uri);
    } catch (const Error& e) {
        file.fail(name, ": ", e.what());
    }
    if (bytes.size() < *length)
        file.fail(name, ": byteLength is ", *length, ", but ",
                  uri.empty()                ? "the file's binary chunk"
                  : uri.starts_with("data:") ? "its data URI"
                                             : "'" + uri + "'",
                  " has only ", bytes.size(), " bytes");
    bytes.resize(*length);  // a file may be longer, a chunk is padded
    return bytes;
}

std::string one_line(std::string text) {
    constexpr std::size_t max_length = 300;  // tinygltf quotes whole data URIs
    std::ranges::replace(text, '\n', ' ');
    while (text.ends_with(' ')) text.pop_back();
    return text.size() > max_length ? text.substr(0, max_length) + "..." : text;
}

std::shared_ptr<const json> take_motion(json& root) {
    json motion = json::object();
    for (const char* key : {"animations", "skins"}) {
        motion[key] = root.value(key, json());
        root.erase(key);
    }
    return std::make_shared<const json>(std::move(motion));
}

void parse_model(GltfFile& file, const json& root) {
    const std::string source = root.dump();
    if (source.size() > UINT32_MAX) file.fail("the JSON is over 4 GiB");
    tinygltf::TinyGLTF parser;
    std::string error, warning;
    bool is_parsed = false;
    try {
        is_parsed = parser.LoadASCIIFromString(&file.model, &error, &warning, source.data(),
                                               static_cast<unsigned>(source.size()), "", tinygltf::REQUIRE_VERSION);
    } catch (const std::exception& e) {
        error += e.what();
    }
    // tinygltf reports members of a wrong type in `error` and goes on without them; the scene would silently be wrong.
    if (!is_parsed || !error.empty()) file.fail("not valid glTF: ", error.empty() ? "unknown reason" : one_line(error));
    if (!warning.empty()) file.warn(one_line(warning));
}

std::vector<tinygltf::Buffer> take_buffers(const GltfFile& file, GltfJson& source) {
    std::vector<tinygltf::Buffer> buffers;
    for (const json& entry : source.root.value("buffers", json::array())) {
        tinygltf::Buffer buffer;
        buffer.name = json_string(entry, "name");
        if (!is_meshopt_placeholder(entry)) buffer.data = read_buffer(file, entry, buffers.size(), source.binary);
        buffers.push_back(std::move(buffer));
    }
    source.root.erase("buffers");
    return buffers;
}

std::vector<tinygltf::Image> take_images(json& root) {
    std::vector<tinygltf::Image> images;
    for (const json& entry : root.value("images", json::array())) {
        tinygltf::Image image;
        image.name = json_string(entry, "name");
        image.uri = json_string(entry, "uri");
        image.mimeType = json_string(entry, "mimeType");
        const auto view = json_count(entry, "bufferView");
        image.bufferView = view && *view <= INT32_MAX ? static_cast<int>(*view) : -1;
        images.push_back(std::move(image));
    }
    root.erase("images");
    return images;
}

}  // namespace

Bytes read_uri(const GltfFile& file, const std::string& uri) {
    if (uri.starts_with("data:")) return read_data_uri(uri);
    return read_file(file.path.parent_path() / platform::path_of(decode_percent(uri)));
}

std::span<const std::uint8_t> stream_bytes(const GltfFile& file, const json& range,
                                           const std::vector<tinygltf::Buffer>& buffers, const std::string& object) {
    const auto length = json_count(range, "byteLength");
    const std::uint64_t buffer = json_count(range, "buffer").value_or(UINT64_MAX);
    const std::uint64_t offset = json_count(range, "byteOffset").value_or(0);
    if (!length || buffer >= buffers.size())
        file.fail(object, ": byteLength is missing, or its buffer does not exist; the file has ", buffers.size());
    const auto& data = buffers[buffer].data;
    if (offset > data.size() || *length > data.size() - offset)
        file.fail(object, ": takes ", *length, " bytes from byte ", offset, ", but buffer ", buffer, " has only ",
                  data.size(), " bytes");
    return {data.data() + offset, *length};
}

std::span<const std::uint8_t> view_bytes(const GltfFile& file, int view, const std::string& object) {
    const tinygltf::BufferView& v = file.entry(file.model.bufferViews, view, object, "bufferView");
    if (v.buffer < 0 || std::size_t(v.buffer) >= file.model.buffers.size())
        file.fail(object, ": bufferView ", view, " names buffer ", v.buffer, "; the file has ",
                  file.model.buffers.size());
    const auto& data = file.model.buffers[std::size_t(v.buffer)].data;
    if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset)
        file.fail(object, ": bufferView ", view, " takes ", v.byteLength, " bytes from byte ", v.byteOffset,
                  ", but buffer ", v.buffer, " has only ", data.size(), " bytes");
    return {data.data() + v.byteOffset, v.byteLength};
}

GltfFile open_gltf(const std::filesystem::path& path) {
    GltfFile file{.path = path, .model = {}, .motion = {}, .warnings = {}};
    GltfJson source = read_gltf_json(file);
    check_extensions(file, source.root);
    std::vector<tinygltf::Buffer> buffers = take_buffers(file, source);
    std::vector<tinygltf::Image> images = take_images(source.root);
    file.motion = take_motion(source.root);
    check_types(file, source.root);
    decode_meshopt_views(file, source.root, buffers);
    decode_draco_primitives(file, source.root, buffers);
    parse_model(file, source.root);
    // Morph targets that move few of a mesh's vertices have such accessors, with as many elements as it has vertices.
    file.zeros_left = std::size_t{1} << 22;
    for (const tinygltf::Buffer& buffer : buffers) file.zeros_left += 64 * buffer.data.size();
    file.model.buffers = std::move(buffers);
    file.model.images = std::move(images);
    return file;
}

std::string gltf_name(const char* kind, std::size_t index, const std::string& name) {
    return name.empty() ? text(kind, " ", index) : text(kind, " ", index, " '", name, "'");
}

const tinygltf::Value* find_member(const tinygltf::Value& object, const std::string& key) {
    return object.Has(key) ? &object.Get(key) : nullptr;
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double number_or(const tinygltf::Value& object, const std::string& key, double fallback) {
    const tinygltf::Value* member = find_member(object, key);
    return member && member->IsNumber() ? member->GetNumberAsDouble() : fallback;
}

int index_of(const tinygltf::Value& object, const std::string& key) {
    const double number = number_or(object, key, -1);
    return number >= 0 && number <= INT32_MAX ? static_cast<int>(number) : -1;
}

std::vector<double> numbers_of(const tinygltf::Value& object, const std::string& key) {
    std::vector<double> numbers;
    const tinygltf::Value* member = find_member(object, key);
    if (!member || !member->IsArray()) return numbers;
    for (int i = 0; i < static_cast<int>(member->ArrayLen()); ++i)
        if (const tinygltf::Value& entry = member->Get(i); entry.IsNumber())
            numbers.push_back(entry.GetNumberAsDouble());
    return numbers;
}

}  // namespace twinray
