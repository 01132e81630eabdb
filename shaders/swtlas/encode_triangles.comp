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
    BvhTriangle fetched = fetch_primitive(tree, AT(args.order, position) - tree.first);
    if (!has_boxes(tree)) fetched = without_inactive_corners(fetched);
    AT(tree.triangles, position - tree.first) = fetched;
}
