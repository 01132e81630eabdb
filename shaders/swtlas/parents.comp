// SPDX-License-Identifier: MIT
// The parent of each inner node and of each leaf of finished trees, one invocation per inner node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { ParentsArgs args; };

void set_parent(uint first, uint child, uint parent)
{
    if ((child & LEAF_BIT) != 0u)
        AT(args.leaf_parents, first + (child & ~LEAF_BIT)) = parent;
    else
        AT(args.node_parents, first + child) = parent;
}

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    if (gl_LocalInvocationIndex >= block.count) return;
    BuildTree tree = AT(args.trees, block.tree);
    uint node = block.first - tree.first + gl_LocalInvocationIndex;
    if (node == 0u) set_parent(tree.first, AT(tree.bvh, 0).root, NOTHING);
    if (node + 1u >= tree.count) return;
    BvhNode children = AT(tree.nodes, node);
    set_parent(tree.first, children.child0, node << 1u);
    set_parent(tree.first, children.child1, node << 1u | 1u);
}
