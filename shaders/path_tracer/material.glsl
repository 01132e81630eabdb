// SPDX-License-Identifier: MIT
// Material factors times textures, at a surface.
#ifndef TWINRAY_PATH_TRACER_MATERIAL_GLSL
#define TWINRAY_PATH_TRACER_MATERIAL_GLSL

vec4 base_color(SceneData scene, uint material, uint flags, vec2 uv)
{
    vec4 color = AT(scene.materials, material).base_color;
    if (HAS_TEXTURES && (flags & MATERIAL_BASE_TEXTURE) != 0u)
        color *= sample_texture(scene.images, AT(scene.materials, material).base_texture, uv, true);
    return color;
}

vec3 emission(SceneData scene, uint material, uint flags, vec2 uv)
{
    vec3 color = AT(scene.materials, material).emission;
    if (HAS_TEXTURES && (flags & MATERIAL_EMISSION_TEXTURE) != 0u && largest(color) > 0.0)
        color *= sample_texture(scene.images, AT(scene.materials, material).emission_texture, uv, true).rgb;
    return color;
}

// Radiance leaving the surface on the given side.
vec3 emitted(SceneData scene, uint material, uint flags, vec2 uv, bool is_front)
{
    if (!is_front && (flags & MATERIAL_TWO_SIDED) == 0u) return vec3(0.0);
    return emission(scene, material, flags, uv);
}

float opacity(uint flags, float cutoff, float alpha)
{
    if ((flags & MATERIAL_MASKED) != 0u) return alpha < cutoff ? 0.0 : 1.0;
    return (flags & MATERIAL_BLENDED) != 0u ? clamp(alpha, 0.0, 1.0) : 1.0;
}

// The shading normal on the side of wo: mapped, turned to the viewer, and bent until the viewer can see it, since no
// BSDF is defined below the horizon.
vec3 shading_normal(SceneData scene, Surface surface, uint flags, vec3 wo)
{
    vec3 normal = surface.normal;
    if (HAS_TEXTURES && (flags & MATERIAL_NORMAL_TEXTURE) != 0u)
    {
        TextureSlot slot = AT(scene.materials, surface.material).normal_texture;
        vec3 mapped = sample_texture(scene.images, slot, surface.uv, false).xyz * 2.0 - 1.0;
        mapped.xy *= AT(scene.materials, surface.material).normal_scale;
        float t = length(surface.tangent);
        float b = length(surface.bitangent);
        if (t > 0.0 && b > 0.0)
            normal = normalize(surface.tangent * (mapped.x / t) + surface.bitangent * (mapped.y / b) +
                               normal * mapped.z);
    }
    bool is_front = dot(surface.point.normal, wo) >= 0.0;
    normal = is_front ? normal : -normal;
    const float least_cosine = 0.01;
    float cosine = dot(normal, wo);
    return cosine < least_cosine ? normalize(normal + wo * (least_cosine - cosine)) : normal;
}

Bsdf glass_of(SceneData scene, Surface surface, vec3 color, float roughness, bool is_front)
{
    float ior = max(AT(scene.materials, surface.material).ior, 1e-3);
    Bsdf bsdf;
    bsdf.is_glass = true;
    bsdf.diffuse = color;
    bsdf.f0 = vec3(0.0);
    bsdf.f90 = 0.0;
    bsdf.alpha = roughness * roughness;
    bsdf.eta = is_front ? ior : 1.0 / ior;
    return bsdf;
}

// glTF 2.0, appendix B. An index of refraction of 1 is no interface at all, so nothing reflects, at grazing neither.
Bsdf opaque_of(vec3 color, float metallic, float roughness, float ior)
{
    float root = (ior - 1.0) / (ior + 1.0);
    Bsdf bsdf;
    bsdf.is_glass = false;
    bsdf.diffuse = color * (1.0 - metallic);
    bsdf.f0 = mix(vec3(root * root), color, metallic);
    bsdf.f90 = mix(ior == 1.0 ? 0.0 : 1.0, 1.0, metallic);
    bsdf.alpha = roughness * roughness;
    bsdf.eta = 1.0;
    return bsdf;
}

// Where a material transmits in part, `choice` decides which part is met.
Bsdf bsdf_of(SceneData scene, Surface surface, uint flags, vec3 color, bool is_front, float choice)
{
    float metallic = AT(scene.materials, surface.material).metallic;
    float roughness = AT(scene.materials, surface.material).roughness;
    if (HAS_TEXTURES && (flags & MATERIAL_ROUGHNESS_TEXTURE) != 0u)
    {
        TextureSlot slot = AT(scene.materials, surface.material).roughness_texture;
        vec4 map = sample_texture(scene.images, slot, surface.uv, false);
        roughness *= map.g;
        metallic *= map.b;
    }
    if (HAS_GLASS)
    {
        float transmission = AT(scene.materials, surface.material).transmission;
        if (HAS_TEXTURES && (flags & MATERIAL_TRANSMISSION_TEXTURE) != 0u)
            transmission *= sample_texture(scene.images, AT(scene.materials, surface.material).transmission_texture,
                                           surface.uv, false).r;
        if (choice < transmission * (1.0 - metallic)) return glass_of(scene, surface, color, roughness, is_front);
    }
    return opaque_of(color, metallic, roughness, AT(scene.materials, surface.material).ior);
}
#endif
