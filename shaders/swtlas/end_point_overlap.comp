// SPDX-License-Identifier: MIT
// The end-point overlap of a geometry's tree, one invocation a leaf or record.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/end_point_overlap.h"
layout(local_size_x = OVERLAP_GROUP) in;
layout(push_constant, scalar) uniform Push { OverlapArgs args; };

shared float overlaps[OVERLAP_GROUP];
shared float areas[OVERLAP_GROUP];

OverlapSum measured(uint index)
{
    SwGeometry geometry = AT(args.geometry, 0);
    if (is_null(geometry.records))
        return overlap_of(geometry, load_triangle(geometry.triangles, index), LEAF_BIT | index);
    CompressedRecord record = load_record(geometry.records, index);
    if (is_leaf(record)) return overlap_of(geometry, primitive_of(record), index);
    OverlapSum none;
    none.overlap = 0.0;
    none.area = 0.0;
    return none;
}

void main()
{
    uint thread = gl_LocalInvocationIndex;
    overlaps[thread] = 0.0;
    areas[thread] = 0.0;
    if (global_index() < args.count)
    {
        OverlapSum own = measured(global_index());
        overlaps[thread] = own.overlap;
        areas[thread] = own.area;
    }
    barrier();
    for (uint stride = OVERLAP_GROUP / 2u; stride > 0u; stride /= 2u)
    {
        if (thread < stride)
        {
            overlaps[thread] += overlaps[thread + stride];
            areas[thread] += areas[thread + stride];
        }
        barrier();
    }
    if (thread != 0u || global_index() >= args.count) return;
    OverlapSum sum;
    sum.overlap = overlaps[0];
    sum.area = areas[0];
    AT(args.sums, group_index()) = sum;
}
