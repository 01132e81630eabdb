// SPDX-License-Identifier: MIT
// Links the inner nodes of built trees to those above them, one invocation per node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { LinkNodesArgs args; };

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    if (gl_LocalInvocationIndex >= block.count) return;
    BuildTree tree = AT(args.trees, block.tree);
    uint node = block.first - tree.first + gl_LocalInvocationIndex;
    if (node + 1u >= tree.count) return;
    if (node == AT(tree.bvh, 0).root) set_edge(tree.nodes, node, 0u);
    link_children(tree.nodes, node);
}
