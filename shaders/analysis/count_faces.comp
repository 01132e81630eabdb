// SPDX-License-Identifier: MIT
// Adds the hits of two neighbouring rays to the counts of their groups.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/count_faces.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CountFacesArgs args; };

void add_odd(uint group)
{
    atomicAdd(AT(args.counts, group).hits, 1u);
    atomicAdd(AT(args.counts, group).odd, 1u);
}

void main()
{
    uint ray = 2u * global_index();
    if (ray >= args.ray_count) return;
    uint a = group_of(args, ray);
    uint b = ray + 1u < args.ray_count ? group_of(args, ray + 1u) : NO_GROUP;
    if (a == b)
    {
        if (a != NO_GROUP) atomicAdd(AT(args.counts, a).hits, 2u);
        return;
    }
    if (a != NO_GROUP) add_odd(a);
    if (b != NO_GROUP) add_odd(b);
    if (a == NO_GROUP || b == NO_GROUP) atomicAdd(AT(args.counts, args.group_count).odd, 1u);
}
