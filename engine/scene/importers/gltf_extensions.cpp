// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "engine/scene/images.h"
#include "engine/scene/importers/gltf_json.h"

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
    return supported.contains(extension) || is_decoded(extension);
}

// Returns whether the extension says how a surface looks, what shines on it, what a file means or what may happen, not
// where its triangles are: the scene is shown without it.
bool is_optional_by_nature(const std::string& extension) {
    static const std::string_view families[] = {"KHR_materials_",
                                                "EXT_materials_",
                                                "KHR_texture_",
                                                "EXT_texture_",
                                                "MSFT_texture_",
                                                "MSFT_packing_",
                                                "KHR_lights_",
                                                "EXT_lights_",
                                                "KHR_xmp",
                                                "KHR_physics_",
                                                "KHR_audio_",
                                                "MSFT_audio_",
                                                "KHR_interactiv",
                                                "KHR_animation_",
                                                "VRM",
                                                "KHR_environ",
                                                "EXT_structural_metadata",
                                                "EXT_mesh_features",
                                                "EXT_instance_features",
                                                "EXT_feature_metadata"};
    static const std::set<std::string_view> others = {"ADOBE_materials_clearcoat_specular",
                                                      "ADOBE_materials_clearcoat_tint",
                                                      "ADOBE_materials_thin_transparency",
                                                      "AGI_articulations",
                                                      "AGI_stk_metadata",
                                                      "EXT_gltf_audio",
                                                      "FB_geometry_metadata",
                                                      "FB_ngon_encoding",
                                                      "KHR_collision_shapes",
                                                      "KHR_implicit_shapes",
                                                      "KHR_node_hoverability",
                                                      "KHR_node_selectability",
                                                      "KHR_rigid_bodies",
                                                      "KHR_techniques_webgl",
                                                      "MSFT_lod",
                                                      "NV_materials_mdl",
                                                      "OMI_collider",
                                                      "OMI_physics_body",
                                                      "OMI_physics_gravity",
                                                      "OMI_physics_joint",
                                                      "OMI_physics_shape"};
    return others.contains(extension) ||
           std::ranges::any_of(families, [&](std::string_view family) { return extension.starts_with(family); });
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

}  // namespace twinray
