// SPDX-License-Identifier: MIT
#include "renderer/surface_records.h"

#include <cmath>

namespace twinray::path_tracer {
namespace {

// The set of the first map that needs tangents.
uint tangent_uv_set(const Material& material) {
    for (const Texture* map :
         {&material.normal_texture, &material.clearcoat_normal_texture, &material.anisotropy_texture})
        if (map->image >= 0) return map->uv_set;
    return 0;
}

// In float64, so that tiny and huge vectors keep their direction; 0 where there is none: of 0, NaN and infinities.
vec3 unit_or_zero(dvec3 v) {
    const double size = length(v);
    return size > 0 && std::isfinite(size) ? vec3(v / size) : vec3(0);
}

// Without a direction: none.
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

}  // namespace

std::vector<SurfaceVertex> vertex_records(const Mesh& mesh) {
    std::vector<SurfaceVertex> records(mesh.positions.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].position = mesh.positions[i];
        records[i].normal = mesh.normals.empty() ? vec3(0) : unit_or_zero(dvec3(mesh.normals[i]));
        records[i].uv = mesh.uvs.empty() ? vec2(0) : mesh.uvs[i];
        records[i].tangent = mesh.tangents.empty() ? vec4(0) : tangent_record(mesh.tangents[i]);
    }
    return records;
}

std::vector<SurfaceTriangle> triangle_records(const Mesh& mesh) {
    std::vector<SurfaceTriangle> records;
    records.reserve(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) records.push_back({mesh.triangles[i], mesh.material(i)});
    return records;
}

std::vector<SurfaceMaterial> material_records(const Scene& scene, TextureList& textures) {
    std::vector<SurfaceMaterial> records;
    for (const Material& material : scene.materials) records.push_back(material_record(material, textures));
    return records;
}

SurfaceInstance instance_record(const Transform& transform) {
    SurfaceInstance record{};
    record.object_to_world = {transform.rows[0], transform.rows[1], transform.rows[2]};
    record.world_to_object = inverse_of(record.object_to_world);
    return record;
}

}  // namespace twinray::path_tracer
