#include "renderer/surface_records.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinray::path_tracer {
namespace {

// Returns the UV set of the first map that needs tangents.
uint tangent_uv_set(const Material& material) {
    for (const Texture* map :
         {&material.normal_texture, &material.clearcoat_normal_texture, &material.anisotropy_texture})
        if (map->image >= 0) return map->uv_set;
    return 0;
}

// Computes in float64, so that tiny and huge vectors keep their direction. Returns 0 for 0, NaN and infinities.
vec3 unit_or_zero(dvec3 v) {
    const double size = length(v);
    return size > 0 && std::isfinite(size) ? vec3(v / size) : vec3(0);
}

// Returns 0 for a tangent without a direction.
vec4 tangent_record(vec4 tangent) {
    const vec3 direction = unit_or_zero(dvec3(tangent));
    return direction == vec3(0) ? vec4(0) : vec4(direction, tangent.w < 0 ? -1 : 1);
}

SurfaceMaterial material_record(const Material& material, TextureList& textures) {
    SurfaceMaterial record{};
    uint flags = 0;
    const auto slot = [&](const Texture& texture, uint flag, bool is_srgb = false) {
        if (texture.image >= 0) flags |= flag;
        return textures.slot_of(texture, is_srgb);
    };
    if (material.alpha_mode == AlphaMode::mask) flags |= MATERIAL_MASKED;
    if (material.alpha_mode == AlphaMode::blend) flags |= MATERIAL_BLENDED;
    if (material.double_sided) flags |= MATERIAL_TWO_SIDED;
    if (material.unlit) flags |= MATERIAL_UNLIT;
    if (tangent_uv_set(material) == 1) flags |= MATERIAL_SECOND_TANGENTS;
    record.base_texture = slot(material.base_color_texture, MATERIAL_BASE_TEXTURE, true);
    record.roughness_texture = slot(material.metallic_roughness_texture, MATERIAL_ROUGHNESS_TEXTURE);
    record.emission_texture = slot(material.emission_texture, MATERIAL_EMISSION_TEXTURE, true);
    record.normal_texture = slot(material.normal_texture, MATERIAL_NORMAL_TEXTURE);
    record.transmission_texture = slot(material.transmission_texture, MATERIAL_TRANSMISSION_TEXTURE);
    record.base_color = material.base_color;
    record.emission = material.emission;
    record.flags = flags;
    record.metallic = material.metallic;
    record.roughness = material.roughness;
    record.transmission = material.transmission;
    record.ior = material.ior;
    record.normal_scale = material.normal_scale;
    record.alpha_cutoff = material.alpha_cutoff;
    return record;
}

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

TextureSlot TextureList::slot_of(const Texture& texture, bool is_srgb) {
    if (texture.image < 0) return {};
    const SampledTexture sampled{static_cast<uint>(texture.image),
                                 {texture.wrap_u, texture.wrap_v, is_srgb, texture.filter}};
    auto found = std::find(textures.begin(), textures.end(), sampled);
    if (found == textures.end()) found = textures.insert(found, sampled);
    return {{static_cast<uint>(found - textures.begin()) + 1}, texture.uv_set, texture.uv_row0, texture.uv_row1};
}

std::vector<vec3> unit_normals(const Mesh& mesh) {
    std::vector<vec3> units;
    units.reserve(mesh.normals.size());
    for (const vec3& normal : mesh.normals) units.push_back(unit_or_zero(dvec3(normal)));
    return units;
}

std::vector<vec4> unit_tangents(const Mesh& mesh) {
    std::vector<vec4> units;
    units.reserve(mesh.tangents.size());
    for (const vec4& tangent : mesh.tangents) units.push_back(tangent_record(tangent));
    return units;
}

std::vector<SurfaceMaterial> material_records(const Scene& scene, TextureList& textures) {
    std::vector<SurfaceMaterial> records;
    for (const Material& material : scene.materials) records.push_back(material_record(material, textures));
    return records;
}

std::vector<LayeredMaterial> layered_records(const Scene& scene, TextureList& textures) {
    std::vector<LayeredMaterial> records;
    for (const Material& material : scene.materials) records.push_back(record_of(material, textures));
    return records;
}

SurfaceInstance instance_record(const Transform& transform) {
    SurfaceInstance record{};
    record.object_to_world = {transform.rows[0], transform.rows[1], transform.rows[2]};
    record.world_to_object = inverse_of(record.object_to_world);
    return record;
}

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

}  // namespace twinray::path_tracer
