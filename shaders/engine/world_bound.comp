// SPDX-License-Identifier: MIT
// A box around all usable instances, and how many are not: a tree in workgroup memory, then atomics; the last group
// writes the result.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/world_bound.h"
layout(local_size_x = WORLD_BOUND_GROUP) in;
layout(push_constant, scalar) uniform Push { WorldBoundArgs args; };

shared vec3 group_lo[WORLD_BOUND_GROUP];
shared vec3 group_hi[WORLD_BOUND_GROUP];

GeometryBox no_box()
{
    GeometryBox box;
    box.lo = vec3(uintBitsToFloat(0x7f800000u));
    box.hi = vec3(uintBitsToFloat(0xff800000u));
    return box;
}

GeometryBox box_of(InstanceRecord record)
{
    if (record.geometry == 0ul) return no_box();
    Rows to_world = to_world_of(record);
    if (!is_usable(to_world, inverse_of(to_world)))
    {
        atomicAdd(AT(args.bits, 0).unusable_count, 1u);
        return no_box();
    }
    GeometryBox box = AT(REF(GeometryBox)(record.geometry), 0);
    if (!(box.lo.x <= box.hi.x)) return no_box();
    return box_in_world(box, to_world);
}

void add_group(GeometryBox box)
{
    uint thread = gl_LocalInvocationIndex;
    group_lo[thread] = box.lo;
    group_hi[thread] = box.hi;
    barrier();
    for (uint stride = WORLD_BOUND_GROUP / 2u; stride > 0u; stride /= 2u)
    {
        if (thread < stride)
        {
            group_lo[thread] = min(group_lo[thread], group_lo[thread + stride]);
            group_hi[thread] = max(group_hi[thread], group_hi[thread + stride]);
        }
        barrier();
    }
    if (thread >= 3u) return;
    atomicMin(AT(args.bits, 0).lo[thread], ordered_bits(group_lo[0][thread]));
    atomicMax(AT(args.bits, 0).hi[thread], ordered_bits(group_hi[0][thread]));
}

void main()
{
    if (group_index() >= args.group_count) return;
    uint index = global_index();
    GeometryBox box = no_box();
    if (index < args.count) box = box_of(AT(args.records, index));
    add_group(box);
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    if (atomicAdd(AT(args.bits, 0).groups_done, 1u) + 1u != args.group_count) return;
    memoryBarrierBuffer();
    WorldBound bound;
    for (uint axis = 0u; axis < 3u; axis++)
    {
        bound.lo[axis] = from_ordered_bits(atomicAdd(AT(args.bits, 0).lo[axis], 0u));
        bound.hi[axis] = from_ordered_bits(atomicAdd(AT(args.bits, 0).hi[axis], 0u));
    }
    bound.unusable_count = atomicAdd(AT(args.bits, 0).unusable_count, 0u);
    bound.reserved = 0u;
    AT(args.result, 0) = bound;
}
