// SPDX-License-Identifier: MIT
// Computes a box around the centres of all boxes that are not empty.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/box_tree.h"
layout(local_size_x = WORLD_BOUND_GROUP) in;
#include "shaders/engine/group_box.glsl"
layout(push_constant, scalar) uniform Push { HilbertOrderArgs args; };

void main()
{
    if (group_index() >= args.group_count) return;
    GeometryBox box = no_box();
    uint stride = args.group_count * WORLD_BOUND_GROUP;
    for (uint i = global_index(); i < args.count; i += stride)
    {
        TreeBox given = AT(args.boxes, i);
        vec3 center = center_of(given);
        if (is_empty(given) || !is_finite(center)) continue;
        box.lo = min(box.lo, center);
        box.hi = max(box.hi, center);
    }
    add_box(args.bits, args.group_count, box);
}
