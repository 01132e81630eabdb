// SPDX-License-Identifier: MIT
// Computes the keys by which rays are sorted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/ray_order.h"
layout(local_size_x = WORLD_BOUND_GROUP) in;
layout(push_constant, scalar) uniform Push { RayOrderArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    // The sort is stable: of rays with the last key, those within the count stay before those beyond.
    uint key = LAST_RAY_KEY;
    if (i < ray_count(args.count, args.indirect_count)) key = ray_key(AT(args.rays, i), box_of(AT(args.box, 0)));
    AT(args.keys, i) = key;
}
