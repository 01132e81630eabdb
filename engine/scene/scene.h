// SPDX-License-Identifier: MIT
// A scene as loaded from a file: meshes, their instances and what is needed to shade and view them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <twinray/geometry.h>
#include "engine/scene/mesh.h"

namespace twinray {

// 8-bit RGBA, row 0 first (glTF's v = 0). sRGB or linear is decided by the use (base colour and emission: sRGB).
struct Image {
    std::string name;
    uint width = 0;
    uint height = 0;
    std::vector<std::uint8_t> rgba;
    bool is_placeholder = false;  // a checkerboard in place of an image that could not be decoded
};

enum class Wrap : std::uint8_t { repeat, clamp_to_edge, mirrored_repeat };
enum class Filter : std::uint8_t { linear, nearest };  // of texels that are magnified

// An image with its sampling: uv' = rotation/scale/offset of KHR_texture_transform applied to the mesh's uv.
struct Texture {
    std::int32_t image = -1;  // index into Scene::images, -1 = none
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    Filter filter = Filter::linear;
    uint uv_set = 0;  // of the mesh, 0 or 1: see Mesh::uv_set
    // uv' = (row0 . (u, v, 1), row1 . (u, v, 1))
    vec3 uv_row0 = vec3(1, 0, 0);
    vec3 uv_row1 = vec3(0, 1, 0);
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

// glTF 2.0 metallic-roughness material with KHR_materials_{anisotropy, clearcoat, emissive_strength, ior, sheen,
// specular, transmission, unlit, volume}. Roughness is perceptual throughout.
struct Material {
    std::string name;
    vec4 base_color = vec4(1);  // linear
    float metallic = 1;
    float roughness = 1;      // perceptual, as glTF; alpha = roughness^2
    vec3 emission = vec3(0);  // linear, emissive_strength multiplied in
    float transmission = 0;
    float ior = 1.5f;
    float specular = 1;             // weight of the dielectric reflection
    vec3 specular_color = vec3(1);  // linear, of its reflectance at normal incidence
    float clearcoat = 0;
    float clearcoat_roughness = 0;
    float clearcoat_normal_scale = 1;
    vec3 sheen_color = vec3(0);  // linear
    float sheen_roughness = 0;
    float anisotropy = 0;
    float anisotropy_rotation = 0;     // radians, from the tangent to the bitangent
    float thickness = 0;               // above 0: what transmits is the boundary of a volume, else a thin wall
    vec3 attenuation_color = vec3(1);  // linear: what is left of white light after attenuation_distance
    float attenuation_distance = INFINITY;
    float normal_scale = 1;
    float alpha_cutoff = 0.5f;
    AlphaMode alpha_mode = AlphaMode::opaque;
    bool double_sided = false;
    bool unlit = false;
    Texture base_color_texture = {}, metallic_roughness_texture = {}, emission_texture = {}, normal_texture = {},
            transmission_texture = {}, specular_texture = {}, specular_color_texture = {}, clearcoat_texture = {},
            clearcoat_roughness_texture = {}, clearcoat_normal_texture = {}, sheen_color_texture = {},
            sheen_roughness_texture = {}, anisotropy_texture = {};
};

// All textures of a material, those without an image too.
std::array<const Texture*, 13> textures_of(const Material& material);

// One placement of a mesh in the world.
struct Instance {
    std::string name;
    uint mesh = 0;  // index into Scene::meshes
    Transform transform;
    std::optional<uint> material = {};  // index into Scene::materials, in place of all of the mesh's
};

// KHR_materials_variants: other materials for the same triangles.
struct MaterialVariant {
    struct Part {
        uint mesh = 0;                // index into Scene::meshes
        std::vector<uint> materials;  // in place of Mesh::materials
    };
    std::string name;
    std::vector<Part> parts;
};

struct Rig;  // engine/scene/animation.h

// Looks along -z of its frame, +y up (glTF).
struct Camera {
    std::string name;
    Transform camera_to_world;
    float vertical_fov = 0.8f;                      // radians; perspective
    std::optional<float> aspect;                    // width / height of its frame, when the file states one
    std::optional<float> orthographic_half_height;  // set: orthographic, in world units
};

// KHR_lights_punctual.
struct Light {
    enum class Kind : std::uint8_t { directional, point, spot };
    std::string name;
    Kind kind = Kind::point;
    vec3 color = vec3(1);  // linear; times intensity: lux (directional) or candela (point, spot)
    vec3 position = vec3(0);
    vec3 direction = vec3(0, 0, -1);  // unit, from the light
    float range = INFINITY;
    float inner_cone = 0;  // radians
    float outer_cone = 0.7853982f;
};

// A point of the file is `origin` plus a point of the scene. The origin is 0 but for files whose coordinates float32
// cannot hold: engine/scene/local_origin.h says which. Rays of such a file are made in float64 and moved before they
// are rounded: ray.origin = vec3(point - scene.origin), and a hit is at scene.origin + dvec3(point).
struct Scene {
    dvec3 origin = dvec3(0);
    std::vector<Mesh> meshes;
    std::vector<Material> materials;  // never empty after load: entry for meshes without one is appended
    std::vector<Image> images;
    std::vector<Instance> instances;  // load_scene leaves them grouped by mesh, ascending
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::vector<MaterialVariant> variants;
    std::shared_ptr<const Rig> rig;     // of files with animations; all else is in the rest pose. Null: nothing moves
    std::vector<std::string> warnings;  // what was skipped or replaced, one clear sentence each
};

// Loads .gltf, .glb (by tinygltf), .obj, .ply or .stl, the last three also with .gz, chosen by the suffix.
// Throws Error naming the file, the object and the limit on anything that cannot be rendered faithfully. `origin`: of
// the scene, in place of choose_local_origin(); dvec3(0) keeps the file's coordinates, rounded.
Scene load_scene(const std::filesystem::path& file, const std::optional<dvec3>& origin = {});

// Union of all instances' boxes under their transforms, in world space.
Bounds bounds_of(const Scene& scene);

// Triangles counted once per instance.
std::size_t count_triangles(const Scene& scene);

// All instances as one mesh in world space. Corners that meet in the scene meet there, if they are of one instance or
// of one transform.
Mesh joined(const Scene& scene, std::string name);

}  // namespace twinray
