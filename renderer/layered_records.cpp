// SPDX-License-Identifier: MIT
#include "renderer/layered_records.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinray::path_tracer {
namespace {

// exp(-extinction * attenuation_distance) is the attenuation color. Black has a finite extinction, so that its product
// with a way of length 0 is 0.
vec3 extinction_of(const Material& material) {
    if (!std::isfinite(material.attenuation_distance)) return vec3(0);
    const vec3 extinction = -log(material.attenuation_color) / material.attenuation_distance;
    return min(extinction, vec3(std::numeric_limits<float>::max()));
}

LayeredMaterial record_of(const Material& material, TextureList& textures) {
    LayeredMaterial record{};
    record.layers = layers_of(material);
    const auto slot = [&](const Texture& texture, uint flag, bool is_srgb = false) {
        if (texture.image >= 0) record.textures |= flag;
        return textures.slot_of(texture, is_srgb);
    };
    record.specular_texture = slot(material.specular_texture, LAYERED_SPECULAR);
    record.specular_color_texture = slot(material.specular_color_texture, LAYERED_SPECULAR_COLOR, true);
    record.coat_texture = slot(material.clearcoat_texture, LAYERED_COAT);
    record.coat_roughness_texture = slot(material.clearcoat_roughness_texture, LAYERED_COAT_ROUGHNESS);
    record.coat_normal_texture = slot(material.clearcoat_normal_texture, LAYERED_COAT_NORMAL);
    record.sheen_color_texture = slot(material.sheen_color_texture, LAYERED_SHEEN_COLOR, true);
    record.sheen_roughness_texture = slot(material.sheen_roughness_texture, LAYERED_SHEEN_ROUGHNESS);
    record.anisotropy_texture = slot(material.anisotropy_texture, LAYERED_ANISOTROPY);
    record.specular = material.specular;
    record.specular_color = material.specular_color;
    record.coat = material.clearcoat;
    record.coat_roughness = material.clearcoat_roughness;
    record.coat_normal_scale = material.clearcoat_normal_scale;
    record.sheen_color = material.sheen_color;
    record.sheen_roughness = material.sheen_roughness;
    record.anisotropy = material.anisotropy;
    record.grain = {std::cos(material.anisotropy_rotation), std::sin(material.anisotropy_rotation)};
    record.extinction = extinction_of(material);
    return record;
}

}  // namespace

uint layers_of(const Material& material) {
    uint layers = 0;
    const bool has_specular_texture =
        material.specular_texture.image >= 0 || material.specular_color_texture.image >= 0;
    if (material.specular != 1 || material.specular_color != vec3(1) || has_specular_texture) layers |= LAYER_SPECULAR;
    if (material.clearcoat > 0) layers |= LAYER_COAT;
    if (material.sheen_color != vec3(0)) layers |= LAYER_SHEEN;
    if (material.anisotropy > 0) layers |= LAYER_ANISOTROPY;
    if (material.thickness > 0 && material.transmission > 0) layers |= LAYER_VOLUME;
    return layers;
}

std::vector<LayeredMaterial> layered_records(const Scene& scene, TextureList& textures) {
    std::vector<LayeredMaterial> records;
    for (const Material& material : scene.materials) records.push_back(record_of(material, textures));
    return records;
}

bool has_texture(const Material& material) {
    return std::ranges::any_of(textures_of(material), [](const Texture* texture) { return texture->image >= 0; });
}

bool has_second_uvs(const Material& material) {
    return std::ranges::any_of(textures_of(material),
                               [](const Texture* texture) { return texture->image >= 0 && texture->uv_set == 1; });
}

}  // namespace twinray::path_tracer
