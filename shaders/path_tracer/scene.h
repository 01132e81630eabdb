// SPDX-License-Identifier: MIT
// The scene as the path tracer's kernels read it from device memory.
#ifndef TWINRAY_PATH_TRACER_SCENE_H
#define TWINRAY_PATH_TRACER_SCENE_H
#include "shaders/path_tracer/light_tree.h"
#include "twinray/glsl/instance.h"
#include "twinray/glsl/multi_type_set.h"
#include "twinray/glsl/textures.h"
#include "twinray/glsl/transform.h"

// Ids of the specialisation constants: features that a scene lacks are compiled out.
const uint PT_HAS_ALPHA = 0u;  // some material is masked or blended: rays may pass surfaces
const uint PT_HAS_TEXTURES = 1u;
const uint PT_HAS_GLASS = 2u;  // some material transmits
const uint PT_HAS_ENVIRONMENT = 3u;
const uint PT_HAS_LOCAL_LIGHTS = 4u;  // emissive triangles or punctual lights
const uint PT_STRATEGY = 5u;          // how direct light is found
const uint PT_HAS_AOVS = 6u;          // first surfaces are noted
const uint PT_FILTER = 7u;            // the part of the picture that a pixel shows
const uint PT_HAS_QUEUES = 8u;        // rays are shaded by the kind of material that they met
// The layers that a material may have (LAYER_ below).
const uint PT_HAS_SPECULAR = 9u;
const uint PT_HAS_COAT = 10u;
const uint PT_HAS_SHEEN = 11u;
const uint PT_HAS_ANISOTROPY = 12u;
const uint PT_HAS_VOLUME = 13u;
const uint PT_HAS_MEDIA = 14u;       // some material of the scene bounds a volume, in which a path may be anywhere
const uint PT_HAS_COLORS = 15u;      // vertices have colors
const uint PT_HAS_SECOND_UVS = 16u;  // some texture takes the second texture coordinates
// some material of the scene is a smooth wall without thickness: shadow rays pass it
const uint PT_HAS_PANES = 17u;
const uint PT_HAS_LIGHT_TREE = 18u;  // two lights or more have a position: the point decides which is chosen

const uint STRATEGY_MIS = 0u;     // both of the following, weighted by the power heuristic
const uint STRATEGY_LIGHTS = 1u;  // sample lights only
const uint STRATEGY_BSDF = 2u;    // sample the surface only: punctual lights are never found

// The arrays of a mesh. All but the first two are absent if it has none.
struct SurfaceMesh {
    PackedMesh packed;
    Floats normals;  // 3 per vertex: unit, or 0 for none: the triangle's is used
    Vec2s uvs;
    Vec4s tangents;  // unit, or 0 for none: derived from uvs
    Vec2s second_uvs;
    Vec4s colors;     // linear
    Uints materials;  // per triangle; absent: 0
};
BUFFER_OF(SurfaceMesh, 8);

// Indexed by Hit::instance_index.
struct SurfaceInstance {
    Rows object_to_world;
    Rows world_to_object;
    REF(SurfaceMesh) mesh;
    Floats emitter_density;  // per triangle: probability of being chosen from its part of the table / world area;
                             // absent if none emits
    Uints emitter_ways;      // per triangle: see chance_of_way; absent without a tree
};
BUFFER_OF(SurfaceInstance, 8);

// A texture and where a material samples it.
struct TextureSlot {
    TextureRef texture;
    uint uv_set;  // 0 or 1: which of the texture coordinates
    vec3 row0;    // uv' = (row0 . (u, v, 1), row1 . (u, v, 1))
    vec3 row1;
};

FUNC vec2 transformed_uv(TextureSlot slot, vec2 uv) {
    return vec2(dot(slot.row0, vec3(uv, 1.0f)), dot(slot.row1, vec3(uv, 1.0f)));
}

const uint MATERIAL_MASKED = 1u;
const uint MATERIAL_BLENDED = 2u;
const uint MATERIAL_TWO_SIDED = 4u;  // emits from its back too
const uint MATERIAL_UNLIT = 8u;
const uint MATERIAL_BASE_TEXTURE = 16u;
const uint MATERIAL_ROUGHNESS_TEXTURE = 32u;
const uint MATERIAL_EMISSION_TEXTURE = 64u;
const uint MATERIAL_NORMAL_TEXTURE = 128u;
const uint MATERIAL_TRANSMISSION_TEXTURE = 256u;
const uint MATERIAL_SECOND_TANGENTS = 512u;  // tangents are derived from the second texture coordinates

struct SurfaceMaterial {
    vec4 base_color;
    vec3 emission;
    uint flags;
    float metallic;
    float roughness;
    float transmission;
    float ior;
    float normal_scale;
    float alpha_cutoff;
    TextureSlot base_texture;
    TextureSlot roughness_texture;
    TextureSlot emission_texture;
    TextureSlot normal_texture;
    TextureSlot transmission_texture;
};
BUFFER_OF(SurfaceMaterial, 4);

// The layers of a material beyond the plain metallic-roughness surface.
const uint LAYER_SPECULAR = 1u;  // a weight or color of the dielectric reflection; in a Bsdf: a color
const uint LAYER_COAT = 2u;
const uint LAYER_SHEEN = 4u;
const uint LAYER_ANISOTROPY = 8u;
const uint LAYER_VOLUME = 16u;  // the transmitting surface bounds a volume, else it is a thin wall

// Bits of the textures that a LayeredMaterial has.
const uint LAYERED_SPECULAR = 1u;
const uint LAYERED_SPECULAR_COLOR = 2u;
const uint LAYERED_COAT = 4u;
const uint LAYERED_COAT_ROUGHNESS = 8u;
const uint LAYERED_COAT_NORMAL = 16u;
const uint LAYERED_SHEEN_COLOR = 32u;
const uint LAYERED_SHEEN_ROUGHNESS = 64u;
const uint LAYERED_ANISOTROPY = 128u;

// Indexed by material.
struct LayeredMaterial {
    uint layers;    // LAYER_ bits
    uint textures;  // LAYERED_ bits
    float specular;
    vec3 specular_color;
    float coat;
    float coat_roughness;
    float coat_normal_scale;
    vec3 sheen_color;
    float sheen_roughness;
    float anisotropy;
    vec2 grain;       // unit, by tangent and bitangent
    vec3 extinction;  // per unit of length in the world
    TextureSlot specular_texture;
    TextureSlot specular_color_texture;
    TextureSlot coat_texture;
    TextureSlot coat_roughness_texture;
    TextureSlot coat_normal_texture;
    TextureSlot sheen_color_texture;
    TextureSlot sheen_roughness_texture;
    TextureSlot anisotropy_texture;
};
BUFFER_OF(LayeredMaterial, 4);

// One column of an alias table: it counts if a random 32-bit fraction is below `probability`, else `alias` does.
struct AliasEntry {
    uint probability;
    uint alias;
};
BUFFER_OF(AliasEntry, 8);

struct Emitter {
    uint instance;
    uint primitive;
    uint material;
};
BUFFER_OF(Emitter, 4);

// Custom indices of instances name materials that replace the mesh's; 0: none does.
FUNC uint material_of(uint custom_index, uint of_triangle) {
    return custom_index != 0u ? custom_index - 1u : of_triangle;
}

const uint PUNCTUAL_DIRECTIONAL = 0u;
const uint PUNCTUAL_POINT = 1u;
const uint PUNCTUAL_SPOT = 2u;

// KHR_lights_punctual.
struct PunctualLight {
    vec3 position;
    uint kind;
    vec3 direction;    // from the light
    float range;       // infinity: none
    vec3 color;        // times intensity
    float chance;      // of being chosen from its part of the table
    float cone_scale;  // spot: clamp(cos * scale + offset, 0, 1)^2
    float cone_offset;
};
BUFFER_OF(PunctualLight, 4);

// The scene's lights with a position, in contrast to the environment.
#define LOCAL_LIGHTS(X, P) X(P, 0, Emitter, emitters) X(P, 1, PunctualLight, punctual)
TWINRAY_SET_VIEW(LocalLightsView, LOCAL_LIGHTS)

// The radiance of a pixel of the environment, or the sum over the samples of a pixel of the picture.
struct Radiance {
    vec3 rgb;
};
BUFFER_OF(Radiance, 4);

// Radiance by direction, latitude-longitude, row 0 around +y. A pixel is chosen with probability proportional to its
// luminance times its solid angle, then a direction uniformly within it.
struct Environment {
    REF(Radiance) pixels;
    Floats row_sums;     // height + 1 cumulated probabilities of the rows, from 0 to 1
    Floats column_sums;  // for each row, width + 1 cumulated probabilities within the row
    uint width;
    uint height;
    float density_per_luminance;  // probability density by solid angle = this * luminance of the pixel
    float chance;                 // of sampling the environment instead of a local light
};

struct SceneData {
    REF(SurfaceInstance) instances;
    REF(SurfaceMaterial) materials;
    REF(LayeredMaterial) layered;  // absent: no material has layers
    Uints material_kinds;          // of the materials; absent where all are of one
    TextureTable textures;         // of the materials; empty: none has any
    LocalLightsView lights;
    REF(SetKey) light_keys;       // by the index of a light
    REF(AliasEntry) light_table;  // by the index of a light, in parts: of each leaf of the tree and of all other lights
    REF(LightNode) light_tree;    // of the lights that are somewhere; absent without PT_HAS_LIGHT_TREE
    uint table_first;             // of the lights that are not in the tree
    uint table_count;
    float table_chance;  // of choosing one of them
    uint reserved;
    Environment environment;
};
BUFFER_OF(SceneData, 8);
#endif
