// Checks the JSON before tinygltf sees it: extensions, and members of a wrong type, which tinygltf ignores silently and
// a scene would then lack.
#include <set>

#include "engine/scene/images.h"
#include "engine/scene/importers/gltf_json.h"
#include "engine/scene/importers/words.h"

namespace twinray {
namespace {

using nlohmann::json;

// Returns whether this twinray was built with the library that reads the extension.
bool is_decoded(const std::string& extension) {
    if (extension == "EXT_texture_webp") return has_library(Codec::webp);
    if (extension == "EXT_texture_avif") return has_library(Codec::avif);
#ifdef TWINRAY_HAS_MESHOPT
    if (extension == "EXT_meshopt_compression" || extension == "KHR_meshopt_compression") return true;
#endif
#ifdef TWINRAY_HAS_DRACO
    if (extension == "KHR_draco_mesh_compression") return true;
#endif
    return false;
}

// Returns whether the name is one of the words or, with `is_family`, begins with one.
bool is_among(std::string_view words, std::string_view name, bool is_family = false) {
    for (std::string_view word = cut_word(words); !word.empty(); word = cut_word(words))
        if (is_family ? name.starts_with(word) : name == word) return true;
    return false;
}

bool is_supported(const std::string& extension) {
    constexpr std::string_view names =
        "EXT_mesh_gpu_instancing KHR_lights_punctual KHR_materials_anisotropy KHR_materials_clearcoat "
        "KHR_materials_emissive_strength KHR_materials_ior KHR_materials_pbrSpecularGlossiness KHR_materials_sheen "
        "KHR_materials_specular KHR_materials_transmission KHR_materials_unlit KHR_materials_volume "
        "KHR_materials_variants KHR_mesh_quantization KHR_node_visibility KHR_texture_transform";
    return is_among(names, extension) || is_decoded(extension);
}

// Returns whether the extension says how a surface looks, what shines on it, what a file means or what may happen, not
// where its triangles are: the scene is shown without it.
bool is_optional_by_nature(const std::string& extension) {
    constexpr std::string_view families =
        "KHR_materials_ EXT_materials_ KHR_texture_ EXT_texture_ MSFT_texture_ MSFT_packing_ KHR_lights_ EXT_lights_ "
        "KHR_xmp KHR_physics_ KHR_audio_ MSFT_audio_ KHR_interactiv KHR_animation_ VRM KHR_environ "
        "EXT_structural_metadata EXT_mesh_features EXT_instance_features EXT_feature_metadata";
    constexpr std::string_view others =
        "ADOBE_materials_clearcoat_specular ADOBE_materials_clearcoat_tint ADOBE_materials_thin_transparency "
        "AGI_articulations AGI_stk_metadata EXT_gltf_audio FB_geometry_metadata FB_ngon_encoding KHR_collision_shapes "
        "KHR_implicit_shapes KHR_node_hoverability KHR_node_selectability KHR_rigid_bodies KHR_techniques_webgl "
        "MSFT_lod NV_materials_mdl OMI_collider OMI_physics_body OMI_physics_gravity OMI_physics_joint "
        "OMI_physics_shape";
    return is_among(others, extension) || is_among(families, extension, true);
}

std::string_view advice(const std::string& extension) {
    static const std::map<std::string_view, std::string_view> remedies = {
        {"KHR_draco_mesh_compression", "decompress it, for example with `gltf-transform copy in.glb out.glb`"},
        {"EXT_meshopt_compression", "decompress it, for example with `gltf-transform copy in.glb out.glb`"},
        {"KHR_meshopt_compression", "decompress it with `gltfpack -noq -kn -km -i in.glb -o out.glb`"}};
    const auto found = remedies.find(extension);
    return found != remedies.end() ? found->second : "export it again without this extension";
}

[[noreturn]] void refuse(const GltfFile& file, const std::string& extension) {
    file.fail("needs the glTF extension ", extension, ", which is not supported; ", advice(extension));
}

std::set<std::string> strings_of(const json& root, const char* key) {
    std::set<std::string> strings;
    if (const auto list = root.find(key); list != root.end() && list->is_array())
        for (const json& entry : *list)
            if (entry.is_string()) strings.insert(entry.get<std::string>());
    return strings;
}

const json& list_of(const json& object, const char* key) {
    static const json empty = json::array();
    const auto list = object.find(key);
    return list != object.end() && list->is_array() ? *list : empty;
}

// Returns whether there is no uncompressed data to fall back to: some exporters list Draco as merely used all the same.
bool lacks_draco_fallback(const json& root) {
    const json& accessors = list_of(root, "accessors");
    for (const json& mesh : list_of(root, "meshes"))
        for (const json& primitive : list_of(mesh, "primitives")) {
            if (!primitive.is_object() || !has_extension(primitive, "KHR_draco_mesh_compression")) continue;
            const auto attributes = primitive.find("attributes");
            if (attributes == primitive.end()) continue;
            const auto position = json_count(*attributes, "POSITION");
            if (position && *position < accessors.size() && !accessors[*position].contains("bufferView")) return true;
        }
    return false;
}

// Returns whether a fallback buffer of meshopt has no URI, so that it holds nothing.
bool lacks_meshopt_fallback(const json& root, const char* name) {
    for (const json& buffer : list_of(root, "buffers"))
        if (has_extension(buffer, name) && !buffer.contains("uri")) return true;
    return false;
}

// A type of members.
struct Kind {
    const char* description;
    bool (json::*is)() const noexcept;
    bool is_list = false;  // of values that are so

    bool fits(const json& value) const {
        return is_list ? value.is_array() && std::ranges::all_of(value, is) : (value.*is)();
    }
};
constexpr Kind one_index = {"a non-negative integer", &json::is_number_unsigned};
constexpr Kind one_number = {"a number", &json::is_number};
constexpr Kind list_of_indices = {"a list of non-negative integers", &json::is_number_unsigned, true};
constexpr Kind list_of_numbers = {"a list of numbers", &json::is_number, true};
constexpr Kind one_object = {"an object", &json::is_object};
constexpr Kind list_of_objects = {"a list of objects", &json::is_object, true};

// glTF uses these keys with one meaning everywhere.
const Kind* kind_of(const std::string& key) {
    struct Keys {
        const Kind& kind;
        std::set<std::string_view> names;
    };
    static const Keys all[] = {
        {one_index, {"buffer",  "bufferView", "byteLength", "byteOffset", "byteStride", "camera",     "componentType",
                     "count",   "index",      "material",   "mesh",       "mode",       "NORMAL",     "POSITION",
                     "sampler", "scene",      "source",     "TANGENT",    "texCoord",   "TEXCOORD_0", "TEXCOORD_1",
                     "COLOR_0", "JOINTS_0",   "JOINTS_1",   "WEIGHTS_0",  "WEIGHTS_1"}},
        {one_number, {"metallicFactor", "roughnessFactor"}},
        {list_of_indices, {"children"}},
        {list_of_numbers, {"baseColorFactor", "emissiveFactor", "matrix", "rotation", "translation"}},
        {one_object,
         {"attributes", "baseColorTexture", "emissiveTexture", "extensions", "metallicRoughnessTexture",
          "normalTexture", "orthographic", "pbrMetallicRoughness", "perspective", "sparse"}},
        {list_of_objects,
         {"accessors", "bufferViews", "cameras", "materials", "meshes", "primitives", "samplers", "scenes",
          "textures"}}};
    for (const auto& [kind, names] : all)
        if (names.contains(key)) return &kind;
    return nullptr;
}

const Kind* kind_of(const std::string& key, const json& parent, const std::string& parent_path) {
    const bool is_root = parent.contains("asset");
    const bool is_texture = parent_path.ends_with("Texture");
    const bool is_morphed = parent_path.starts_with("/meshes/") && parent_path.find("extensions") == std::string::npos;
    const bool is_node = parent_path.starts_with("/nodes/") && parent_path.find("extensions") == std::string::npos;
    if (key == "targets" && is_morphed) return &list_of_objects;
    if (key == "weights" && (is_morphed || is_node)) return &list_of_numbers;
    if (key == "skin" && is_node) return &one_index;
    if (key == "nodes") return is_root ? &list_of_objects : &list_of_indices;  // of the file or of a scene
    if (key == "scale") return is_texture ? &one_number : &list_of_numbers;    // of a normal map or of a node
    return kind_of(key);
}

void check(const GltfFile& file, const json& value, const std::string& path) {
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) check(file, value[i], text(path, "/", i));
    if (!value.is_object()) return;
    for (const auto& [key, member] : value.items()) {
        if (key == "extras") continue;
        const std::string member_path = path + "/" + key;
        if (const Kind* kind = kind_of(key, value, path); kind && !kind->fits(member))
            file.fail("JSON ", member_path, " is ", member.dump().substr(0, 40), ", not ", kind->description);
        if (key != "extensions") {
            check(file, member, member_path);
            continue;
        }
        for (const auto& [name, extension] : member.items())
            if (!extension.is_object()) file.fail("JSON ", member_path, "/", name, " is not an object");
    }
}

}  // namespace

bool has_extension(const json& object, const char* name) {
    const auto extensions = object.find("extensions");
    return extensions != object.end() && extensions->is_object() && extensions->contains(name);
}

void check_extensions(GltfFile& file, const json& root) {
    for (const std::string& extension : strings_of(root, "extensionsRequired"))
        if (!is_supported(extension) && !is_optional_by_nature(extension)) refuse(file, extension);
    if (const char* draco = "KHR_draco_mesh_compression"; !is_decoded(draco) && lacks_draco_fallback(root))
        refuse(file, draco);
    for (const char* meshopt : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (!is_decoded(meshopt) && lacks_meshopt_fallback(root, meshopt)) refuse(file, meshopt);

    std::set<std::string> used = strings_of(root, "extensionsUsed");
    used.merge(strings_of(root, "extensionsRequired"));
    used.erase("FB_ngon_encoding");  // tells which triangles were one face, and nothing of their look
    std::string ignored;
    for (const std::string& extension : used)
        if (!is_supported(extension)) ignored += (ignored.empty() ? "" : ", ") + extension;
    if (!ignored.empty()) file.warn("shown without the glTF extensions " + ignored);
}

void check_types(const GltfFile& file, const json& root) { check(file, root, ""); }

}  // namespace twinray
