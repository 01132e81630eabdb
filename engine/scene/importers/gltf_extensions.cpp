// SPDX-License-Identifier: MIT
#include <map>
#include <set>
#include <string_view>

#include "engine/scene/importers/gltf_json.h"

namespace twinray {
namespace {

using nlohmann::json;

bool is_supported(const std::string& extension) {
    static const std::set<std::string_view> supported = {"EXT_mesh_gpu_instancing",
                                                         "KHR_lights_punctual",
                                                         "KHR_materials_anisotropy",
                                                         "KHR_materials_clearcoat",
                                                         "KHR_materials_emissive_strength",
                                                         "KHR_materials_ior",
                                                         "KHR_materials_pbrSpecularGlossiness",
                                                         "KHR_materials_sheen",
                                                         "KHR_materials_specular",
                                                         "KHR_materials_transmission",
                                                         "KHR_materials_unlit",
                                                         "KHR_materials_volume",
                                                         "KHR_materials_variants",
                                                         "KHR_mesh_quantization",
                                                         "KHR_node_visibility",
                                                         "KHR_texture_transform"};
    return supported.contains(extension);
}

// These say how a surface looks or what a file means, not where its triangles are: the scene is shown without them.
bool is_optional_by_nature(const std::string& extension) {
    static const std::set<std::string_view> metadata = {"KHR_xmp", "KHR_xmp_json_ld", "KHR_animation_pointer",
                                                        "EXT_lights_image_based"};
    return extension.starts_with("KHR_materials_") || metadata.contains(extension);
}

std::string_view advice(const std::string& extension) {
    static const std::map<std::string_view, std::string_view> remedies = {
        {"KHR_draco_mesh_compression", "decompress it, for example with `gltf-transform copy in.glb out.glb`"},
        {"EXT_meshopt_compression", "decompress it, for example with `gltf-transform copy in.glb out.glb`"},
        {"KHR_meshopt_compression", "decompress it, for example with `gltf-transform copy in.glb out.glb`"},
        {"KHR_texture_basisu", "convert its images, for example with `gltf-transform ktxdecompress in.glb out.glb`"},
        {"EXT_texture_webp", "convert its images to PNG, for example with `gltf-transform png in.glb out.glb`"}};
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

bool has_extension(const json& object, const char* name) {
    const auto extensions = object.find("extensions");
    return extensions != object.end() && extensions->is_object() && extensions->contains(name);
}

const json& list_of(const json& object, const char* key) {
    static const json empty = json::array();
    const auto list = object.find(key);
    return list != object.end() && list->is_array() ? *list : empty;
}

// Some exporters list Draco as merely used, yet leave no uncompressed data to fall back to.
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

// A meshopt fallback buffer without a URI holds nothing.
bool lacks_meshopt_fallback(const json& root) {
    for (const json& buffer : list_of(root, "buffers"))
        if (has_extension(buffer, "EXT_meshopt_compression") && !buffer.contains("uri")) return true;
    return false;
}

}  // namespace

void check_extensions(GltfFile& file, const json& root) {
    for (const std::string& extension : strings_of(root, "extensionsRequired"))
        if (!is_supported(extension) && !is_optional_by_nature(extension)) refuse(file, extension);
    if (lacks_draco_fallback(root)) refuse(file, "KHR_draco_mesh_compression");
    if (lacks_meshopt_fallback(root)) refuse(file, "EXT_meshopt_compression");

    std::string ignored;
    for (const std::string& extension : strings_of(root, "extensionsUsed"))
        if (!is_supported(extension)) ignored += (ignored.empty() ? "" : ", ") + extension;
    if (!ignored.empty()) file.warn("shown without the glTF extensions " + ignored);
}

}  // namespace twinray
