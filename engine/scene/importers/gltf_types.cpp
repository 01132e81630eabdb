// SPDX-License-Identifier: MIT
// Finds members of a wrong type, which tinygltf ignores silently and a scene would then lack.
#include <algorithm>
#include <set>
#include <string_view>

#include "engine/scene/importers/gltf_json.h"

namespace twinray {
namespace {

using nlohmann::json;

enum class Kind { index, number, indices, numbers, object, objects };

bool is_list(const json& value, bool (*accepts)(const json&)) {
    return value.is_array() && std::ranges::all_of(value, accepts);
}

bool is(Kind kind, const json& value) {
    switch (kind) {
        case Kind::index: return value.is_number_unsigned();
        case Kind::number: return value.is_number();
        case Kind::indices: return is_list(value, [](const json& entry) { return entry.is_number_unsigned(); });
        case Kind::numbers: return is_list(value, [](const json& entry) { return entry.is_number(); });
        case Kind::object: return value.is_object();
        case Kind::objects: return is_list(value, [](const json& entry) { return entry.is_object(); });
    }
    return false;
}

const char* description(Kind kind) {
    switch (kind) {
        case Kind::index: return "a non-negative integer";
        case Kind::number: return "a number";
        case Kind::indices: return "a list of non-negative integers";
        case Kind::numbers: return "a list of numbers";
        case Kind::object: return "an object";
        case Kind::objects: return "a list of objects";
    }
    return "";
}

// glTF uses these keys with one meaning everywhere.
std::optional<Kind> kind_of(const std::string& key) {
    struct Keys {
        Kind kind;
        std::set<std::string_view> names;
    };
    static const Keys all[] = {
        {Kind::index, {"buffer",  "bufferView", "byteLength", "byteOffset", "byteStride", "camera",     "componentType",
                       "count",   "index",      "material",   "mesh",       "mode",       "NORMAL",     "POSITION",
                       "sampler", "scene",      "source",     "TANGENT",    "texCoord",   "TEXCOORD_0", "TEXCOORD_1",
                       "COLOR_0", "JOINTS_0",   "JOINTS_1",   "WEIGHTS_0",  "WEIGHTS_1"}},
        {Kind::number, {"metallicFactor", "roughnessFactor"}},
        {Kind::indices, {"children"}},
        {Kind::numbers, {"baseColorFactor", "emissiveFactor", "matrix", "rotation", "translation"}},
        {Kind::object,
         {"attributes", "baseColorTexture", "emissiveTexture", "extensions", "metallicRoughnessTexture",
          "normalTexture", "orthographic", "pbrMetallicRoughness", "perspective", "sparse"}},
        {Kind::objects,
         {"accessors", "bufferViews", "cameras", "materials", "meshes", "primitives", "samplers", "scenes",
          "textures"}}};
    for (const auto& [kind, names] : all)
        if (names.contains(key)) return kind;
    return std::nullopt;
}

std::optional<Kind> kind_of(const std::string& key, const json& parent, const std::string& parent_path) {
    const bool is_root = parent.contains("asset");
    const bool is_texture = parent_path.ends_with("Texture");
    const bool is_morphed = parent_path.starts_with("/meshes/") && parent_path.find("extensions") == std::string::npos;
    const bool is_node = parent_path.starts_with("/nodes/") && parent_path.find("extensions") == std::string::npos;
    if (key == "targets" && is_morphed) return Kind::objects;
    if (key == "weights" && (is_morphed || is_node)) return Kind::numbers;
    if (key == "skin" && is_node) return Kind::index;
    if (key == "nodes") return is_root ? Kind::objects : Kind::indices;    // of the file or of a scene
    if (key == "scale") return is_texture ? Kind::number : Kind::numbers;  // of a normal map or of a node
    return kind_of(key);
}

void check(const GltfFile& file, const json& value, const std::string& path) {
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) check(file, value[i], text(path, "/", i));
    if (!value.is_object()) return;
    for (const auto& [key, member] : value.items()) {
        if (key == "extras") continue;
        const std::string member_path = path + "/" + key;
        if (const auto kind = kind_of(key, value, path); kind && !is(*kind, member))
            file.fail("JSON ", member_path, " is ", member.dump().substr(0, 40), ", not ", description(*kind));
        if (key != "extensions") {
            check(file, member, member_path);
            continue;
        }
        for (const auto& [name, extension] : member.items())
            if (!extension.is_object()) file.fail("JSON ", member_path, "/", name, " is not an object");
    }
}

}  // namespace

void check_types(const GltfFile& file, const json& root) { check(file, root, ""); }

}  // namespace twinray
