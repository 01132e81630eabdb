// SPDX-License-Identifier: MIT
// Adds the light of shadow rays that nothing blocks. With transparent surfaces or panes in the scene a shadow ray looks
// for its closest hit, is dimmed by it and goes on in the next round, until nothing is left of it or it is through.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/path_tracer/includes.glsl"
layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { WaveArgs args; };

WaveData wave;

// Returns the light that glass lets pass straight on: that of a pane.
vec3 passed_as_glass(SceneData scene, Ray ray, Surface surface, uint flags, vec3 color) {
    vec2 factors = roughness_and_metallic(scene, surface, flags);
    vec3 wo = -normalize(ray.direction);
    bool is_front = dot(surface.point.normal, wo) >= 0.0;
    Bsdf bsdf = glass_of(scene, surface, color, factors.x, is_front);
    vec3 normal = shading_normal(scene, surface, flags, wo);
    if (LAYERS != 0u) set_layers(bsdf, scene, surface, normal, wo, is_front);
    if (!is_pane(bsdf)) return vec3(0.0);
    return passed_by_pane(bsdf, to_local(frame_about(normal), wo)) * glass_part(scene, surface, flags, factors.y);
}

void pass(Ray ray, vec3 contribution, uint pixel, Hit hit) {
    SceneData scene = AT(wave.scene, 0);
    Surface surface = surface_of(scene, ray, hit);
    uint flags = AT(scene.materials, surface.material).flags;
    bool is_transparent = (flags & (MATERIAL_MASKED | MATERIAL_BLENDED)) != 0u;
    bool is_glass =
        HAS_PANES && (flags & MATERIAL_UNLIT) == 0u && AT(scene.materials, surface.material).transmission > 0.0;
    if (!is_transparent && !is_glass) return;
    vec4 color = base_color(scene, surface, flags);
    float opaque = opacity(flags, AT(scene.materials, surface.material).alpha_cutoff, color.a);
    vec3 passed = vec3(1.0 - opaque);
    if (is_glass && opaque > 0.0) passed += passed_as_glass(scene, ray, surface, flags, color.rgb) * opaque;
    contribution *= passed;
    if (passed == vec3(0.0) || contribution == vec3(0.0)) return;
    uint slot = atomicAdd(AT(wave.counters, 0).shadows, 1u);
    AT(wave.next_shadow_rays, slot) = behind(ray, surface);
    AT(wave.next_shadows.contribution, slot) = contribution;
    AT(wave.next_shadows.pixel, slot) = pixel;
}

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    wave = AT(args.wave, 0);
    Hit hit = AT(wave.hits, i);
    vec3 contribution = AT(wave.shadows.contribution, i);
    uint pixel = AT(wave.shadows.pixel, i);
    if (hit.hit == 0u) {
        if (is_finite(contribution))
            AT(wave.sums, pixel).rgb += contribution;
        else
            atomicAdd(AT(wave.counters, 0).non_finite, 1u);
    } else if (HAS_ALPHA || HAS_PANES)
        pass(AT(wave.shadow_rays, i), contribution, pixel, hit);
}
