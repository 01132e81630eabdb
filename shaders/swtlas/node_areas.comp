// SPDX-License-Identifier: MIT
// The areas of the child boxes of a group's nodes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/compressed.h"
#include "shaders/shared/surface_area.h"
layout(local_size_x = AREA_GROUP) in;
layout(push_constant, scalar) uniform Push { NodeAreasArgs args; };

shared float sums[AREA_GROUP];

float area_of(Bvh tree, uint index)
{
    float unit = area_unit(tree.lo, tree.hi);
    if (uint64_t(args.record_boxes) != 0ul) return areas_of_boxes(load_record(args.records, index), args.record_boxes, unit);
    if (uint64_t(args.records) != 0ul) return areas_in(load_record(args.records, index), unit);
    BvhNode node = AT(tree.nodes, index);
    return half_area(node.lo0, node.hi0, unit) + half_area(node.lo1, node.hi1, unit);
}

void main()
{
    uint index = global_index();
    uint thread = gl_LocalInvocationIndex;
    sums[thread] = index < args.count ? area_of(AT(args.tree, 0), index) : 0.0f;
    barrier();
    for (uint stride = 1u; stride < AREA_GROUP; stride *= 2u)
    {
        if (thread % (2u * stride) == 0u) sums[thread] += sums[thread + stride];
        barrier();
    }
    if (thread != 0u || index >= args.count) return;
    AreaItem item = no_area();
    item.sum = sums[0];
    AT(args.items, group_index()) = item;
}
