// SPDX-License-Identifier: MIT
// The areas of the child boxes of a group's nodes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/surface_area.h"
layout(local_size_x = AREA_GROUP) in;
layout(push_constant, scalar) uniform Push { NodeAreasArgs args; };

shared float sums[AREA_GROUP];

void main()
{
    uint index = global_index();
    uint thread = gl_LocalInvocationIndex;
    Bvh tree = AT(args.tree, 0);
    float unit = area_unit(tree.lo, tree.hi);
    sums[thread] = 0.0f;
    if (index < args.node_count)
    {
        BvhNode node = AT(tree.nodes, index);
        sums[thread] = half_area(node.lo0, node.hi0, unit) + half_area(node.lo1, node.hi1, unit);
    }
    barrier();
    for (uint stride = 1u; stride < AREA_GROUP; stride *= 2u)
    {
        if (thread % (2u * stride) == 0u) sums[thread] += sums[thread + stride];
        barrier();
    }
    if (thread != 0u || index >= args.node_count) return;
    AreaItem item = no_area();
    item.sum = sums[0];
    AT(args.items, group_index()) = item;
}
