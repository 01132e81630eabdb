// SPDX-License-Identifier: MIT
// The BSDF of a surface, without the layers from set_layers.
#ifndef TWINRAY_PATH_TRACER_BSDF_OF_GLSL
#define TWINRAY_PATH_TRACER_BSDF_OF_GLSL

Bsdf glass_of(SceneData scene, Surface surface, vec3 color, float roughness, bool is_front) {
    float ior = max(AT(scene.materials, surface.material).ior, 1e-3);
    Bsdf bsdf = plain_bsdf();
    bsdf.is_glass = true;
    bsdf.diffuse = color;
    bsdf.alpha = roughness * roughness;
    bsdf.layers = volume_of(scene, surface.material);
    bsdf.eta = is_front || is_thin(bsdf) ? ior : 1.0 / ior;
    return bsdf;
}

// Returns them as x and y.
vec2 roughness_and_metallic(SceneData scene, Surface surface, uint flags) {
    float metallic = AT(scene.materials, surface.material).metallic;
    float roughness = AT(scene.materials, surface.material).roughness;
    if (HAS_TEXTURES && (flags & MATERIAL_ROUGHNESS_TEXTURE) != 0u) {
        TextureSlot slot = AT(scene.materials, surface.material).roughness_texture;
        vec4 map = sample_data(scene, slot, surface.uv);
        roughness *= map.g;
        metallic *= map.b;
    }
    return vec2(roughness, metallic);
}

// Returns the part of a surface that is glass.
float glass_part(SceneData scene, Surface surface, uint flags, float metallic) {
    float transmission = AT(scene.materials, surface.material).transmission;
    if (HAS_TEXTURES && (flags & MATERIAL_TRANSMISSION_TEXTURE) != 0u)
        transmission *= sample_data(scene, AT(scene.materials, surface.material).transmission_texture, surface.uv).r;
    return transmission * (1.0 - metallic);
}

// If a material transmits in part, `choice` decides which part is met.
Bsdf bsdf_of(SceneData scene, Surface surface, uint flags, vec3 color, bool is_front, float choice) {
    vec2 factors = roughness_and_metallic(scene, surface, flags);
    if (HAS_GLASS && choice < glass_part(scene, surface, flags, factors.y))
        return glass_of(scene, surface, color, factors.x, is_front);
    float ior = AT(scene.materials, surface.material).ior;
    Bsdf bsdf = opaque_of(color, factors.y, factors.x, ior);
    if ((LAYERS & LAYER_SPECULAR) == 0u) return bsdf;
    vec4 specular = specular_of(scene, surface);
    return with_specular(bsdf, color, factors.y, ior, specular.a, specular.rgb);
}
#endif
