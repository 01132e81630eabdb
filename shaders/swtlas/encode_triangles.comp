// SPDX-License-Identifier: MIT
// Writes the triangles in sorted order, with their vertices.
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
    uint position = chunk.first + gl_LocalInvocationIndex;
    BuildTree tree = AT(args.trees, chunk.tree);
    AT(tree.triangles, position - tree.first) = boxed_primitive(tree, AT(args.order, position) - tree.first).primitive;
}
