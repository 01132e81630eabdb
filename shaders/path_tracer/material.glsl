// SPDX-License-Identifier: MIT
// Material factors times textures, at a surface.
#ifndef TWINRAY_PATH_TRACER_MATERIAL_GLSL
#define TWINRAY_PATH_TRACER_MATERIAL_GLSL

vec2 slot_uv(TextureSlot slot, TextureCoordinates uv) {
    return transformed_uv(slot, HAS_SECOND_UVS && slot.uv_set != 0u ? uv.second : uv.first);
}

vec4 sample_color(SceneData scene, TextureSlot slot, TextureCoordinates uv) {
    return sample_texture(scene.textures, slot.texture, slot_uv(slot, uv));
}

vec4 sample_data(SceneData scene, TextureSlot slot, TextureCoordinates uv) {
    return sample_linear_texture(scene.textures, slot.texture, slot_uv(slot, uv));
}

vec4 base_color(SceneData scene, Surface surface, uint flags) {
    vec4 color = AT(scene.materials, surface.material).base_color * surface.color;
    if (HAS_TEXTURES && (flags & MATERIAL_BASE_TEXTURE) != 0u)
        color *= sample_color(scene, AT(scene.materials, surface.material).base_texture, surface.uv);
    return color;
}

vec3 emission(SceneData scene, uint material, uint flags, TextureCoordinates uv) {
    vec3 color = AT(scene.materials, material).emission;
    if (HAS_TEXTURES && (flags & MATERIAL_EMISSION_TEXTURE) != 0u && largest(color) > 0.0)
        color *= sample_color(scene, AT(scene.materials, material).emission_texture, uv).rgb;
    return color;
}

// Returns the radiance that leaves the surface on the given side.
vec3 emitted(SceneData scene, uint material, uint flags, TextureCoordinates uv, bool is_front) {
    if (!is_front && (flags & MATERIAL_TWO_SIDED) == 0u) return vec3(0.0);
    return emission(scene, material, flags, uv);
}

float opacity(uint flags, float cutoff, float alpha) {
    if ((flags & MATERIAL_MASKED) != 0u) return alpha < cutoff ? 0.0 : 1.0;
    return (flags & MATERIAL_BLENDED) != 0u ? clamp(alpha, 0.0, 1.0) : 1.0;
}

vec3 mapped_normal(SceneData scene, Surface surface, TextureSlot slot, float scale) {
    vec3 mapped = sample_data(scene, slot, surface.uv).xyz * 2.0 - 1.0;
    mapped.xy *= scale;
    float t = length(surface.tangent);
    float b = length(surface.bitangent);
    if (!(t > 0.0 && b > 0.0)) return surface.normal;
    return normalize(surface.tangent * (mapped.x / t) + surface.bitangent * (mapped.y / b) + surface.normal * mapped.z);
}

// Turns the normal to the viewer, and bends it until the viewer can see it, since no BSDF is defined below the horizon.
vec3 facing(vec3 normal, Surface surface, vec3 wo) {
    bool is_front = dot(surface.point.normal, wo) >= 0.0;
    normal = is_front ? normal : -normal;
    const float least_cosine = 0.01;
    float cosine = dot(normal, wo);
    return cosine < least_cosine ? normalize(normal + wo * (least_cosine - cosine)) : normal;
}

// Returns the shading normal on the side of wo.
vec3 shading_normal(SceneData scene, Surface surface, uint flags, vec3 wo) {
    vec3 normal = surface.normal;
    if (HAS_TEXTURES && (flags & MATERIAL_NORMAL_TEXTURE) != 0u) {
        TextureSlot slot = AT(scene.materials, surface.material).normal_texture;
        normal = mapped_normal(scene, surface, slot, AT(scene.materials, surface.material).normal_scale);
    }
    return facing(normal, surface, wo);
}
#endif
