// SPDX-License-Identifier: MIT
// A box around all instances, from the box of each geometry and the transforms, rounded outward.
#ifndef TWINRAY_SHARED_WORLD_BOUND_H
#define TWINRAY_SHARED_WORLD_BOUND_H
#include "twinray/glsl/instance.h"
#include "shaders/shared/morton.h"

const uint WORLD_BOUND_GROUP = 256u;

struct WorldBound {
    vec3 lo;  // lo > hi: nothing can be hit
    vec3 hi;
    uint unusable_count;  // instances whose transform is singular or not finite
    uint reserved;
};
BUFFER_OF(WorldBound, 4);

// The same while groups add to it, as ordered bits (see ordered_bits).
struct WorldBoundBits {
    uvec3 lo;
    uvec3 hi;
    uint unusable_count;
    uint groups_done;
};
BUFFER_OF(WorldBoundBits, 4);

FUNC GeometryBox box_of(WorldBoundBits bits) {
    GeometryBox box;
    box.lo = vec3(from_ordered_bits(bits.lo.x), from_ordered_bits(bits.lo.y), from_ordered_bits(bits.lo.z));
    box.hi = vec3(from_ordered_bits(bits.hi.x), from_ordered_bits(bits.hi.y), from_ordered_bits(bits.hi.z));
    return box;
}

struct WorldBoundArgs {
    REF(InstanceRecord) records;
    REF(WorldBoundBits) bits;
    REF(WorldBound) result;
    uint count;
    uint group_count;
};

// Returns the float next to x towards minus infinity. Zero and denormals go to the least normal float below: devices
// may flush the numbers in between.
FUNC float next_below(float x) {
    const float LEAST_NORMAL = 1.17549435082e-38f;
    uint bits = floatBitsToUint(x);
    if (abs(x) < LEAST_NORMAL) return x < 0.0f ? -2.0f * LEAST_NORMAL : -LEAST_NORMAL;
    return uintBitsToFloat(x > 0.0f ? bits - 1u : bits + 1u);
}

// Returns a float not above a.x b.x + a.y b.y + a.z b.z + c, and the largest such one for all but the rarest operands.
FUNC float dot_below(vec3 a, vec3 b, float c) {
    float missing = 0.0f;
    float missing_size = 0.0f;
    PRECISE float sum = doubled_dot(a, b, c, missing, missing_size);
    // Errors of overflowed terms are unknown; then plain rounding and a wide step must do.
    if (!(abs(missing) < uintBitsToFloat(0x7f800000u))) return sum - abs(sum) * 2.384185791015625e-07f;
    PRECISE float lowest = missing - missing_size * 4.76837158203125e-07f;  // 2^-21: 8 roundings
    PRECISE float result = sum + lowest;
    return sum_error(sum, lowest, result) < 0.0f ? next_below(result) : result;
}

// Returns the least coordinate of the box (lo, hi) under `row`, rounded down.
FUNC float reach_below(vec4 row, vec3 lo, vec3 hi) {
    vec3 corner = vec3(row.x > 0.0f ? lo.x : hi.x, row.y > 0.0f ? lo.y : hi.y, row.z > 0.0f ? lo.z : hi.z);
    return dot_below(vec3(row.x, row.y, row.z), corner, row.w);
}

// Returns a box around `box` under `m`.
FUNC GeometryBox box_in_world(GeometryBox box, Rows m) {
    GeometryBox world;
    DONT_UNROLL for (uint axis = 0u; axis < 3u; axis = axis + 1u) {
        vec4 row = axis == 0u ? m.r0 : (axis == 1u ? m.r1 : m.r2);
        world.lo[axis] = reach_below(row, box.lo, box.hi);
        world.hi[axis] = -reach_below(-row, box.lo, box.hi);
    }
    return world;
}

// Returns an instance's world box; lo > hi if nothing of it can be hit. `is_unusable`: because of its transform.
FUNC GeometryBox instance_box(InstanceRecord given, INOUT(bool) is_unusable) {
    const float infinity = uintBitsToFloat(0x7f800000u);
    GeometryBox none;
    none.lo = vec3(infinity);
    none.hi = vec3(-infinity);
    is_unusable = false;
    InstanceRecord record = in_built_units(given);
    if (!has_geometry(record)) return none;
    Rows to_world = to_world_of(record);
    is_unusable = !is_usable(to_world, inverse_of(to_world));
    if (is_unusable) return none;
    GeometryBox box = AT(REF(GeometryBox)(record.geometry), 0);
    if (!(box.lo.x <= box.hi.x)) return none;
    return box_in_world(box, to_world);
}
#endif
