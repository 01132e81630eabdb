// SPDX-License-Identifier: MIT
// The triangles in sorted order, corners inlined.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { EncodeTrianglesArgs args; };

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    if (gl_LocalInvocationIndex >= block.count) return;
    uint position = block.first + gl_LocalInvocationIndex;
    BuildTree tree = AT(args.trees, block.tree);
    BvhTriangle triangle = fetch_primitive(tree, AT(args.order, position) - tree.first);
    if (!has_boxes(tree) && !is_active_triangle(triangle.v0, triangle.v1, triangle.v2))
    {
        triangle.v0 = vec3(0.0f);
        triangle.v1 = vec3(0.0f);
        triangle.v2 = vec3(0.0f);
    }
    AT(tree.triangles, position - tree.first) = triangle;
}
