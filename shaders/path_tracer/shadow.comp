// SPDX-License-Identifier: MIT
// Adds what shadow rays carry where nothing blocks them. With transparent surfaces in the scene a shadow ray looks for
// its closest hit, is dimmed by it and goes on in the next round.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/path_tracer/includes.glsl"
layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { ShadowArgs args; };

WaveData wave;

void pass(Ray ray, vec3 contribution, uint pixel, Hit hit)
{
    SceneData scene = AT(wave.scene, 0);
    Surface surface = surface_of(scene, ray, hit);
    uint flags = AT(scene.materials, surface.material).flags;
    if ((flags & (MATERIAL_MASKED | MATERIAL_BLENDED)) == 0u) return;
    float cutoff = AT(scene.materials, surface.material).alpha_cutoff;
    float passed = 1.0 - opacity(flags, cutoff, base_color(scene, surface, flags).a);
    if (passed <= 0.0) return;
    if (args.is_last != 0u)
    {
        atomicAdd(AT(wave.counters, 0).cut, 1u);
        return;
    }
    ray.t_min = passing_t(surface.point, surface.placement, ray, surface.t);
    uint slot = atomicAdd(AT(wave.counters, 0).shadows, 1u);
    AT(wave.next_shadow_rays, slot) = ray;
    AT(wave.next_shadows.contribution, slot) = contribution * passed;
    AT(wave.next_shadows.pixel, slot) = pixel;
}

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    wave = AT(args.wave, 0);
    Hit hit = AT(wave.hits, i);
    vec3 contribution = AT(wave.shadows.contribution, i);
    uint pixel = AT(wave.shadows.pixel, i);
    if (hit.hit == 0u)
    {
        if (is_finite(contribution)) AT(wave.sums, pixel).rgb += contribution;
        else atomicAdd(AT(wave.counters, 0).non_finite, 1u);
    }
    else if (HAS_ALPHA) pass(AT(wave.shadow_rays, i), contribution, pixel, hit);
}
