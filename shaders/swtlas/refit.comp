// SPDX-License-Identifier: MIT
// Makes new boxes for an old topology: each leaf goes up with its box, and of the two children that arrive at a node
// the second continues with both.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitArgs args; };

// All groups see the same nodes, not through caches of one.
REFERENCE(SharedNodes, coherent, BvhNode items[], 16)

void traverse_bottom_up(BuildTree tree, uint leaf)
{
    SharedNodes nodes = SharedNodes(tree.nodes.address);
    LeafBox box = AT(args.boxes, leaf);
    uint edge = AT(args.parents, leaf);
    while (edge != 0u)
    {
        uint node = parent_of_edge(edge);
        bool is_second = (edge & 1u) != 0u;
        if (is_second)
        {
            AT(nodes, node).lo1 = box.lo;
            AT(nodes, node).hi1 = box.hi;
        }
        else
        {
            AT(nodes, node).lo0 = box.lo;
            AT(nodes, node).hi0 = box.hi;
        }
        memoryBarrierBuffer();
        if (atomicAdd(AT(args.missing, tree.first + node), 1u) == NOTHING) return;
        memoryBarrierBuffer();
        box.lo = min(box.lo, is_second ? AT(nodes, node).lo0 : AT(nodes, node).lo1);
        box.hi = max(box.hi, is_second ? AT(nodes, node).hi0 : AT(nodes, node).hi1);
        edge = edge_of(tree.nodes, node);
    }
    AT(tree.bvh, 0).lo = box.lo;
    AT(tree.bvh, 0).hi = box.hi;
}

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    if (gl_LocalInvocationIndex >= chunk.count) return;
    traverse_bottom_up(AT(args.trees, chunk.tree), chunk.first + gl_LocalInvocationIndex);
}
