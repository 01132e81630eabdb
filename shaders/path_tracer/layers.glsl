// SPDX-License-Identifier: MIT
// The layers of a material beyond the plain surface: factors times textures, and their effect on a BSDF.
#ifndef TWINRAY_PATH_TRACER_LAYERS_GLSL
#define TWINRAY_PATH_TRACER_LAYERS_GLSL

bool has_map(SceneData scene, uint material, uint bit) {
    return HAS_TEXTURES && (AT(scene.layered, material).textures & bit) != 0u;
}

uint volume_of(SceneData scene, uint material) {
    if ((LAYERS & LAYER_VOLUME) == 0u) return 0u;
    return AT(scene.layered, material).layers & LAYER_VOLUME;
}

// Returns the color, and the weight as alpha, of KHR_materials_specular.
vec4 specular_of(SceneData scene, Surface surface) {
    uint m = surface.material;
    vec4 specular = vec4(AT(scene.layered, m).specular_color, AT(scene.layered, m).specular);
    if (has_map(scene, m, LAYERED_SPECULAR))
        specular.a *= sample_data(scene, AT(scene.layered, m).specular_texture, surface.uv).a;
    if (has_map(scene, m, LAYERED_SPECULAR_COLOR))
        specular.rgb *= sample_color(scene, AT(scene.layered, m).specular_color_texture, surface.uv).rgb;
    return specular;
}

// Makes the surface rougher along the grain: KHR_materials_anisotropy.
void set_anisotropy(inout Bsdf bsdf, SceneData scene, Surface surface, vec3 normal) {
    uint m = surface.material;
    float strength = AT(scene.layered, m).anisotropy;
    vec2 turn = AT(scene.layered, m).grain;
    vec2 grain = turn;
    if (has_map(scene, m, LAYERED_ANISOTROPY)) {
        vec3 map = sample_data(scene, AT(scene.layered, m).anisotropy_texture, surface.uv).rgb;
        vec2 mapped = map.rg * 2.0 - 1.0;
        grain = vec2(turn.x * mapped.x - turn.y * mapped.y, turn.y * mapped.x + turn.x * mapped.y);
        strength *= map.b;
    }
    float t = length(surface.tangent);
    float b = length(surface.bitangent);
    if (strength <= 0.0 || !(t > 0.0 && b > 0.0)) return;
    vec2 across = to_local(frame_about(normal), surface.tangent * (grain.x / t) + surface.bitangent * (grain.y / b)).xy;
    if (!(dot(across, across) > 0.0)) return;
    bsdf.layers |= LAYER_ANISOTROPY;
    bsdf.grain = normalize(across);
    bsdf.alpha = max(bsdf.alpha, SMOOTH_ALPHA);
    bsdf.alpha_grain = mix(bsdf.alpha, 1.0, strength * strength);
}

void set_sheen(inout Bsdf bsdf, SceneData scene, Surface surface) {
    uint m = surface.material;
    bsdf.sheen = AT(scene.layered, m).sheen_color;
    bsdf.sheen_roughness = AT(scene.layered, m).sheen_roughness;
    if (has_map(scene, m, LAYERED_SHEEN_COLOR))
        bsdf.sheen *= sample_color(scene, AT(scene.layered, m).sheen_color_texture, surface.uv).rgb;
    if (has_map(scene, m, LAYERED_SHEEN_ROUGHNESS))
        bsdf.sheen_roughness *= sample_data(scene, AT(scene.layered, m).sheen_roughness_texture, surface.uv).a;
    bsdf.sheen_roughness = max(bsdf.sheen_roughness, SHEEN_LEAST_ROUGHNESS);
    if (largest(bsdf.sheen) > 0.0) bsdf.layers |= LAYER_SHEEN;
}

// A coat does not follow the normal map below it.
void set_coat(inout Bsdf bsdf, SceneData scene, Surface surface, vec3 normal, vec3 wo) {
    uint m = surface.material;
    bsdf.coat = AT(scene.layered, m).coat;
    if (has_map(scene, m, LAYERED_COAT))
        bsdf.coat *= sample_data(scene, AT(scene.layered, m).coat_texture, surface.uv).r;
    if (bsdf.coat <= 0.0) return;
    float roughness = AT(scene.layered, m).coat_roughness;
    if (has_map(scene, m, LAYERED_COAT_ROUGHNESS))
        roughness *= sample_data(scene, AT(scene.layered, m).coat_roughness_texture, surface.uv).g;
    vec3 coat_normal = surface.normal;
    if (has_map(scene, m, LAYERED_COAT_NORMAL))
        coat_normal = mapped_normal(scene, surface, AT(scene.layered, m).coat_normal_texture,
                                    AT(scene.layered, m).coat_normal_scale);
    bsdf.layers |= LAYER_COAT;
    bsdf.coat_alpha = roughness * roughness;
    bsdf.coat_normal = to_local(frame_about(normal), facing(coat_normal, surface, wo));
}

// normal: for shading, on the side of wo. The layers over a volume are on its outside.
void set_layers(inout Bsdf bsdf, SceneData scene, Surface surface, vec3 normal, vec3 wo, bool is_front) {
    uint layers = LAYERS & AT(scene.layered, surface.material).layers;
    if ((layers & LAYER_ANISOTROPY) != 0u) set_anisotropy(bsdf, scene, surface, normal);
    if (has_layer(bsdf, LAYER_VOLUME) && !is_front) return;
    if ((layers & LAYER_SHEEN) != 0u) set_sheen(bsdf, scene, surface);
    if ((layers & LAYER_COAT) != 0u) set_coat(bsdf, scene, surface, normal, wo);
}

// Returns the light that remains after a way through a volume (Beer and Lambert).
vec3 transmittance(SceneData scene, uint medium, float distance) {
    return exp(AT(scene.layered, medium - 1u).extinction * -max(distance, 0.0));
}
#endif
