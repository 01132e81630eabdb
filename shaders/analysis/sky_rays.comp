// SPDX-License-Identifier: MIT
// The rays of a run of faces, and the counts of those that meet nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/sky_rays.h"
layout(local_size_x = 64) in;

#ifdef KERNEL_SKY_RAYS
layout(push_constant, scalar) uniform Push { SkyRaysArgs args; };

void main() {
    uint i = global_index();
    if (i < args.ray_count) AT(args.rays, i) = sky_ray(args, i);
}
#endif

#ifdef KERNEL_COUNT_FREE
layout(push_constant, scalar) uniform Push { CountFreeArgs args; };

uint is_free(uint ray) { return AT(args.rays, ray).t_max > 0.0 && AT(args.hits, ray).hit == 0u ? 1u : 0u; }

// Adds the results of two rays of a face to its counts.
void main() {
    uint pair = global_index();
    if (pair >= args.pair_count) return;
    uint pairs_of_face = (args.samples + 1u) / 2u;
    uint face = pair / pairs_of_face;
    uint number = 2u * (pair % pairs_of_face);
    uint ray = face * args.samples + number;
    uint a = is_free(ray);
    uint b = number + 1u < args.samples ? is_free(ray + 1u) : 0u;
    if (a + b == 0u) return;
    atomicAdd(AT(args.counts, args.first_face + face).hits, a + b);
    if (a != b) atomicAdd(AT(args.counts, args.first_face + face).odd, 1u);
}
#endif
