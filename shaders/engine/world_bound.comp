// SPDX-License-Identifier: MIT
// Computes a box around all usable instances, and counts those that are not usable.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/world_bound.h"
layout(local_size_x = WORLD_BOUND_GROUP) in;
#include "shaders/engine/group_box.glsl"
layout(push_constant, scalar) uniform Push { WorldBoundArgs args; };

void main() {
    if (group_index() >= args.group_count) return;
    uint index = global_index();
    GeometryBox box = no_box();
    bool is_unusable = false;
    if (index < args.count) box = instance_box(AT(args.records, index), is_unusable);
    if (is_unusable) atomicAdd(AT(args.bits, 0).unusable_count, 1u);
    if (!add_box(args.bits, args.group_count, box)) return;
    GeometryBox whole = whole_box(args.bits);
    WorldBound bound;
    bound.lo = whole.lo;
    bound.hi = whole.hi;
    bound.unusable_count = atomicAdd(AT(args.bits, 0).unusable_count, 0u);
    bound.reserved = 0u;
    AT(args.result, 0) = bound;
}
