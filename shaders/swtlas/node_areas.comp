// SPDX-License-Identifier: MIT
// Sums the areas of the child boxes of AREA_GROUP nodes. Each invocation adds up its share of them without waiting for
// others, in the order in which more invocations would.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/compressed.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { NodeAreasArgs args; };

const uint SHARE = AREA_GROUP / gl_WorkGroupSize.x;

shared float sums[AREA_GROUP];

float area_of(Bvh tree, float unit, uint index) {
    if (!is_absent(args.records)) return areas_in(args.records, index, unit);
    BvhNode node = AT(tree.nodes, index);
    return half_area(node.lo0, node.hi0, unit) + half_area(node.lo1, node.hi1, unit);
}

void main() {
    Bvh tree = AT(args.tree, 0);
    float unit = area_unit(tree.lo, tree.hi);
    uint begin = gl_LocalInvocationID.x * SHARE;
    DONT_UNROLL for (uint i = begin; i < begin + SHARE; ++i) {
        uint index = group_index() * AREA_GROUP + i;
        sums[i] = index < args.count ? area_of(tree, unit, index) : 0.0f;
    }
    for (uint stride = 1u; stride < SHARE; stride *= 2u)
        for (uint i = begin; i < begin + SHARE; i += 2u * stride) sums[i] += sums[i + stride];
    barrier();
    DONT_UNROLL for (uint stride = SHARE; stride < AREA_GROUP; stride *= 2u) {
        if (begin % (2u * stride) == 0u) sums[begin] += sums[begin + stride];
        barrier();
    }
    if (begin != 0u || group_index() * AREA_GROUP >= args.count) return;
    AreaItem item = no_area();
    item.sum = sums[0];
    AT(args.items, group_index()) = item;
}
