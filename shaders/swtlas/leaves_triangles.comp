// SPDX-License-Identifier: MIT
// Computes the box of each triangle (or copies the box), and the bounds of each tree's centroids.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/swtlas/centroids.glsl"
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    BuildTree tree = AT(args.trees, chunk.tree);
    LeafBox centers = empty_box();
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += gl_WorkGroupSize.x)
    {
        LeafBox box = boxed_leaf(tree, leaf_at(tree, chunk.first + i - tree.first)).box;
        store_box(args.boxes, chunk.first + i, box);
        add_center(centers, box);
    }
    add_centroids(args.centroids, chunk.tree, centers);
}
