// SPDX-License-Identifier: MIT
// Links the inner nodes of built trees to those above them, one invocation per node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    if (gl_LocalInvocationIndex >= chunk.count) return;
    BuildTree tree = AT(args.trees, chunk.tree);
    uint node = chunk.first - tree.first + gl_LocalInvocationIndex;
    if (node + 1u >= tree.count) return;
    if (node == AT(tree.bvh, 0).root) set_edge(tree.nodes, node, 0u);
    link_children(tree.nodes, node);
}
