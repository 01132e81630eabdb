// SPDX-License-Identifier: MIT
#include "engine/scene/importers/gltf_layers.h"

#include <limits>

#include "engine/scene/importers/gltf_factors.h"

namespace twinray {
namespace {

constexpr double no_limit = 1e30;

struct Reader {
    const tinygltf::Value& extension;
    const std::string& object;
    GltfTextures& textures;

    double number(const char* key, double fallback) const { return number_or(extension, key, fallback); }
    vec3 color(const char* key, vec3 fallback, double most = 1) const {
        return color_factor<3>(numbers_of(extension, key), fallback, most);
    }
    Texture texture(const char* key) const { return textures.read(extension, key, object); }

    // Of a map that cannot be read only the shape would be spoiled.
    Texture normal_texture(const char* key) const {
        const Texture normal = texture(key);
        return textures.is_placeholder(normal) ? Texture{} : normal;
    }
};

void read_specular(const Reader& from, Material& material) {
    material.specular = unit_factor(from.number("specularFactor", 1));
    material.specular_color = from.color("specularColorFactor", vec3(1), no_limit);
    material.specular_texture = from.texture("specularTexture");
    material.specular_color_texture = from.texture("specularColorTexture");
}

void read_clearcoat(const Reader& from, Material& material) {
    material.clearcoat = unit_factor(from.number("clearcoatFactor", 0));
    material.clearcoat_roughness = unit_factor(from.number("clearcoatRoughnessFactor", 0));
    material.clearcoat_texture = from.texture("clearcoatTexture");
    material.clearcoat_roughness_texture = from.texture("clearcoatRoughnessTexture");
    material.clearcoat_normal_texture = from.normal_texture("clearcoatNormalTexture");
    if (const tinygltf::Value* normal = find_member(from.extension, "clearcoatNormalTexture"))
        material.clearcoat_normal_scale = clamped_factor(number_or(*normal, "scale", 1), -no_limit, no_limit);
}

void read_sheen(const Reader& from, Material& material) {
    material.sheen_color = from.color("sheenColorFactor", vec3(0));
    material.sheen_roughness = unit_factor(from.number("sheenRoughnessFactor", 0));
    material.sheen_color_texture = from.texture("sheenColorTexture");
    material.sheen_roughness_texture = from.texture("sheenRoughnessTexture");
}

void read_anisotropy(const Reader& from, Material& material) {
    material.anisotropy = unit_factor(from.number("anisotropyStrength", 0));
    material.anisotropy_rotation = clamped_factor(from.number("anisotropyRotation", 0), -no_limit, no_limit);
    material.anisotropy_texture = from.texture("anisotropyTexture");
}

// How thick is what rays tell: only whether there is a volume counts, of which a texture says nothing.
void read_volume(const Reader& from, Material& material) {
    material.thickness = clamped_factor(from.number("thicknessFactor", 0), 0, no_limit);
    material.attenuation_color = from.color("attenuationColor", vec3(1));
    if (find_member(from.extension, "attenuationDistance"))
        material.attenuation_distance =
            clamped_factor(from.number("attenuationDistance", 1), std::numeric_limits<float>::min(), no_limit);
}

}  // namespace

void read_gltf_layer(const std::string& name, const tinygltf::Value& extension, const std::string& object,
                     GltfTextures& textures, Material& material) {
    const Reader from{extension, object, textures};
    if (name == "KHR_materials_specular") read_specular(from, material);
    if (name == "KHR_materials_clearcoat") read_clearcoat(from, material);
    if (name == "KHR_materials_sheen") read_sheen(from, material);
    if (name == "KHR_materials_anisotropy") read_anisotropy(from, material);
    if (name == "KHR_materials_volume") read_volume(from, material);
}

}  // namespace twinray
