// SPDX-License-Identifier: MIT
// Stores the edge that leads to each leaf of built trees, one invocation per inner node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitArgs args; };

void set_leaf(uint first, uint child, uint edge)
{
    if ((child & LEAF_BIT) != 0u) AT(args.parents, first + (child & ~LEAF_BIT)) = edge;
}

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    if (gl_LocalInvocationIndex >= chunk.count) return;
    BuildTree tree = AT(args.trees, chunk.tree);
    uint node = chunk.first - tree.first + gl_LocalInvocationIndex;
    if (node == 0u) set_leaf(tree.first, AT(tree.bvh, 0).root, 0u);
    if (node + 1u >= tree.count) return;
    BvhNode children = AT(tree.nodes, node);
    set_leaf(tree.first, children.child0, make_edge(node, 0u));
    set_leaf(tree.first, children.child1, make_edge(node, 1u));
}
