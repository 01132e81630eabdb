// SPDX-License-Identifier: MIT
// Collapses subtrees, one per group: items wait in a queue, from which the group takes as many as it has invocations.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/collapse.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(constant_id = NODE_WIDTH_CONSTANT) const uint NODE_WIDTH = 4u;
layout(push_constant, scalar) uniform Push { CollapseArgs args; };

// All invocations of a group see the same contents.
REFERENCE(Queue, coherent, CollapseItem items[], 8)

shared uint queued; // how many items ever were

void do_item(BuildTree tree, Queue queue, CollapseItem item)
{
    NodeChildren children = children_of(tree.nodes, item.node_and_level, NODE_WIDTH);
    uint count = 0u;
    UNROLL for (uint i = 0u; i < NODE_WIDTH; i = i + 1u) count += leaves_of_item(children, i) != 0u ? 1u : 0u;
    uint end = 0u;
    if (count != 0u) end = atomicAdd(queued, count); // before all writes, which it waits for on CPUs
    CollapseStep found = write_node(tree, args.leaf_indices, item, children, NODE_WIDTH);
    UNROLL for (uint i = 0u; i < NODE_WIDTH; i = i + 1u)
    {
        if (found.leaves[i] == 0u) continue;
        AT(queue, end) = found.items[i];
        end = end + 1u;
    }
}

void main()
{
    if (group_index() >= AT(args.subtree_level, 0).count) return;
    CollapseItem root = load_item(args.subtrees, group_index());
    BuildTree tree = AT(args.trees, root.tree);
    Queue queue = Queue(address_at(args.queues.address,
                                   queue_begin(tree.first, root.descendants + 1u - records_of_node(NODE_WIDTH)), 16u));
    if (gl_LocalInvocationID.x == 0u)
    {
        AT(queue, 0) = root;
        queued = 1u;
    }
    uint begin = 0u;
    for (;;)
    {
        memoryBarrierBuffer();
        barrier();
        uint end = min(begin + gl_WorkGroupSize.x, queued);
        if (begin == end) return;
        barrier(); // all have read it before any adds to it
        memoryBarrierBuffer();
        uint mine = begin + gl_LocalInvocationID.x;
        if (mine < end) do_item(tree, queue, AT(queue, mine));
        begin = end;
    }
}
