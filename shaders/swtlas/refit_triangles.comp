// SPDX-License-Identifier: MIT
// Refits triangles whose vertices moved: vertices and boxes, in the order of their tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitArgs args; };

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    if (gl_LocalInvocationIndex >= chunk.count) return;
    uint leaf = chunk.first + gl_LocalInvocationIndex;
    BuildTree tree = AT(args.trees, chunk.tree);
    uint position = leaf - tree.first;
    BoxedPrimitive boxed = boxed_primitive(tree, AT(tree.triangles, position).primitive_index);
    store_box(args.boxes, leaf, boxed.box);
    AT(tree.triangles, position) = boxed.primitive;
}
