// SPDX-License-Identifier: MIT
// One box around the boxes of all invocations: a tree in workgroup memory, then atomics; the last group has the result.
#ifndef TWINRAY_ENGINE_GROUP_BOX_GLSL
#define TWINRAY_ENGINE_GROUP_BOX_GLSL
#include "shaders/shared/world_bound.h"

shared vec3 group_lo[WORLD_BOUND_GROUP];
shared vec3 group_hi[WORLD_BOUND_GROUP];

GeometryBox no_box()
{
    GeometryBox box;
    box.lo = vec3(uintBitsToFloat(0x7f800000u));
    box.hi = vec3(uintBitsToFloat(0xff800000u));
    return box;
}

// Called by all invocations of all groups of WORLD_BOUND_GROUP. True for one invocation of all, once every box is in.
bool add_box(REF(WorldBoundBits) bits, uint group_count, GeometryBox box)
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
    if (thread < 3u)
    {
        atomicMin(AT(bits, 0).lo[thread], ordered_bits(group_lo[0][thread]));
        atomicMax(AT(bits, 0).hi[thread], ordered_bits(group_hi[0][thread]));
    }
    memoryBarrierBuffer();
    barrier();
    if (thread != 0u || atomicAdd(AT(bits, 0).groups_done, 1u) + 1u != group_count) return false;
    memoryBarrierBuffer();
    return true;
}

// For the invocation that add_box() picked.
GeometryBox whole_box(REF(WorldBoundBits) bits)
{
    GeometryBox box;
    for (uint axis = 0u; axis < 3u; axis++)
    {
        box.lo[axis] = from_ordered_bits(atomicAdd(AT(bits, 0).lo[axis], 0u));
        box.hi[axis] = from_ordered_bits(atomicAdd(AT(bits, 0).hi[axis], 0u));
    }
    return box;
}
#endif
