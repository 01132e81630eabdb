// SPDX-License-Identifier: MIT
// The box of each triangle (or the box itself), and the bounds of each tree's centroids.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/swtlas/centroids.glsl"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { TriangleLeavesArgs args; };

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    LeafBox box = empty_box();
    if (gl_LocalInvocationIndex < block.count)
    {
        uint leaf = block.first + gl_LocalInvocationIndex;
        BuildTree tree = AT(args.trees, block.tree);
        box = box_of_primitive(tree, leaf - tree.first);
        AT(args.boxes, leaf) = box;
    }
    add_centroids(args.centroids, block.tree, box);
}
