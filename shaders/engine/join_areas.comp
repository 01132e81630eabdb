// SPDX-License-Identifier: MIT
// Sums the areas of a tree's boxes, always in the same order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/surface_area.h"
layout(local_size_x = AREA_GROUP) in;
layout(push_constant, scalar) uniform Push { JoinAreasArgs args; };

shared AreaItem items[AREA_GROUP];

void write_cost(float sum, GeometryBox root, float unit) {
    float area = half_area(root.lo, root.hi, unit);
    TreeCost cost;
    cost.now = area > 0.0f ? sum / area : 0.0f;
    if (args.is_build != 0u) AT(args.kept, 0).at_build = cost.now;
    cost.at_build = args.is_build != 0u ? cost.now : AT(args.kept, 0).at_build;
    AT(args.result, 0) = cost;
}

void main() {
    uint index = global_index();
    uint thread = gl_LocalInvocationIndex;
    GeometryBox root = AT(args.root, 0);
    float unit = area_unit(root.lo, root.hi);
    items[thread] = no_area();
    if (index < args.count) items[thread] = AT(args.items, index);
    barrier();
    DONT_UNROLL for (uint stride = 1u; stride < AREA_GROUP; stride *= 2u) {
        if (thread % (2u * stride) == 0u) items[thread] = join_areas(items[thread], items[thread + stride], unit);
        barrier();
    }
    if (thread != 0u || index >= max(args.count, 1u)) return;
    AT(args.joined, group_index()) = items[0];
    if (!is_absent(args.result)) write_cost(items[0].sum, root, unit);
}
