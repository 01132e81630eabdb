// SPDX-License-Identifier: MIT
// The box of each triangle (or the box itself), and the bounds of each tree's centroids.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/swtlas/centroids.glsl"
layout(push_constant, scalar) uniform Push { TriangleLeavesArgs args; };

void main()
{
    BuildBlock block = AT(args.blocks, min(group_index(), args.block_count - 1u));
    BuildTree tree = AT(args.trees, block.tree);
    if (group_index() >= args.block_count) return;
    LeafBox centers = empty_box();
    for (uint i = gl_LocalInvocationID.x; i < block.count; i += gl_WorkGroupSize.x)
    {
        LeafBox box = box_of_primitive(tree, block.first + i - tree.first);
        store_box(args.boxes, block.first + i, box);
        add_center(centers, box);
    }
    add_centroids(args.centroids, block.tree, centers);
}
