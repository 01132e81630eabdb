// SPDX-License-Identifier: MIT
// Makes the rays of a run of cells, and counts their hits by groups of faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/count_faces.h"
#include "shaders/analysis/ray_grid.h"
layout(local_size_x = 64) in;

#ifdef KERNEL_GRID_RAYS
layout(push_constant, scalar) uniform Push { GridRaysArgs args; };

void main() {
    uint i = global_index();
    if (i < args.count) AT(args.rays, i) = grid_ray(args.grid, args.first + i);
}
#endif

#ifdef KERNEL_COUNT_FACES
layout(push_constant, scalar) uniform Push { CountFacesArgs args; };

void add_odd(uint group) {
    atomicAdd(AT(args.counts, group).hits, 1u);
    atomicAdd(AT(args.counts, group).odd, 1u);
}

// Adds the hits of two neighbouring rays to the counts of their groups.
void main() {
    uint ray = 2u * global_index();
    if (ray >= args.ray_count) return;
    uint a = group_of(args, ray);
    uint b = ray + 1u < args.ray_count ? group_of(args, ray + 1u) : NO_GROUP;
    if (a == b) {
        if (a != NO_GROUP) atomicAdd(AT(args.counts, a).hits, 2u);
        return;
    }
    if (a != NO_GROUP) add_odd(a);
    if (b != NO_GROUP) add_odd(b);
    if (a == NO_GROUP || b == NO_GROUP) atomicAdd(AT(args.counts, args.group_count).odd, 1u);
}
#endif
