// SPDX-License-Identifier: MIT
// The edge that leads to each leaf of built trees, one invocation per inner node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { LeafEdgesArgs args; };

void set_leaf(uint first, uint child, uint edge)
{
    if ((child & LEAF_BIT) != 0u) AT(args.leaf_edges, first + (child & ~LEAF_BIT)) = edge;
}

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    if (gl_LocalInvocationIndex >= block.count) return;
    BuildTree tree = AT(args.trees, block.tree);
    uint node = block.first - tree.first + gl_LocalInvocationIndex;
    if (node == 0u) set_leaf(tree.first, AT(tree.bvh, 0).root, 0u);
    if (node + 1u >= tree.count) return;
    BvhNode children = AT(tree.nodes, node);
    set_leaf(tree.first, children.child0, make_edge(node, 0u));
    set_leaf(tree.first, children.child1, make_edge(node, 1u));
}
