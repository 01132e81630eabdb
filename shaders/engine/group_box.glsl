// SPDX-License-Identifier: MIT
// One box around the boxes of all invocations: a tree in workgroup memory, then atomics; the last group has the result.
// Included after the size of groups.
#ifndef TWINRAY_ENGINE_GROUP_BOX_GLSL
#define TWINRAY_ENGINE_GROUP_BOX_GLSL
#include "shaders/shared/world_bound.h"

shared vec3 group_lo[gl_WorkGroupSize.x];
shared vec3 group_hi[gl_WorkGroupSize.x];

GeometryBox no_box() {
    GeometryBox box;
    box.lo = vec3(uintBitsToFloat(0x7f800000u));
    box.hi = vec3(uintBitsToFloat(0xff800000u));
    return box;
}

// Called by all invocations of a group: joins their boxes to the first.
void join_boxes(vec3 lo, vec3 hi) {
    uint thread = gl_LocalInvocationIndex;
    group_lo[thread] = lo;
    group_hi[thread] = hi;
    barrier();
    DONT_UNROLL for (uint stride = gl_WorkGroupSize.x / 2u; stride > 0u; stride /= 2u) {
        if (thread < stride) {
            group_lo[thread] = min(group_lo[thread], group_lo[thread + stride]);
            group_hi[thread] = max(group_hi[thread], group_hi[thread + stride]);
        }
        barrier();
    }
}

// Called by all invocations of all groups. Returns true in one invocation of all, once every box is in.
bool add_box(REF(WorldBoundBits) bits, uint group_count, GeometryBox box) {
    uint thread = gl_LocalInvocationIndex;
    join_boxes(box.lo, box.hi);
    if (thread < 3u) {
        atomicMin(AT(bits, 0).lo[thread], ordered_bits(group_lo[0][thread]));
        atomicMax(AT(bits, 0).hi[thread], ordered_bits(group_hi[0][thread]));
    }
    memoryBarrierBuffer();
    barrier();
    if (thread != 0u || atomicAdd(AT(bits, 0).groups_done, 1u) + 1u != group_count) return false;
    memoryBarrierBuffer();
    return true;
}

// Returns the whole box. Called by the invocation that add_box() picked.
GeometryBox whole_box(REF(WorldBoundBits) bits) {
    GeometryBox box;
    for (uint axis = 0u; axis < 3u; axis++) {
        box.lo[axis] = from_ordered_bits(atomicAdd(AT(bits, 0).lo[axis], 0u));
        box.hi[axis] = from_ordered_bits(atomicAdd(AT(bits, 0).hi[axis], 0u));
    }
    return box;
}
#endif
