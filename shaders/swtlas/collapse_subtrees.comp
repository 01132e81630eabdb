// SPDX-License-Identifier: MIT
// Collapses subtrees, a group each: items wait in a queue, from which the group takes as many as it has invocations.
// Nodes and records of a subtree lie side by side, so that a CPU has them in its caches once they are loaded one line
// after the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/collapse.h"
#include "shaders/swtlas/ahead.glsl"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { CollapseArgs args; };

// As all invocations of a group see it.
REFERENCE(Queue, coherent, CollapseItem items[], 8)

shared uint queued; // how many items ever were

// Where rotations have moved nodes, these are other ones of the tree.
void load_ahead(BuildTree tree, CollapseItem root)
{
    BvhNode node = load_node(tree.nodes, node_at(root.place));
    uint left = leaves_in(node.below0);
    uint leaves = left + leaves_in(node.below1);
    uint first = node_at(root.place) + 1u - min(left, node_at(root.place) + 1u);
    uint nodes = min(leaves - 1u, tree.count - 1u - first);
    load_lines(address_at(tree.nodes.address, first, 64u), nodes * 64u, gl_WorkGroupSize.x);
    load_lines(address_at(tree.records.address, root.below, 40u), records_below(leaves) * 40u, gl_WorkGroupSize.x);
}

void do_item(BuildTree tree, Queue queue, CollapseItem item)
{
    NodeChildren children = children_of(tree.nodes, item.place);
    uint count = 0u;
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u) count += leaves_of_item(children, i) != 0u ? 1u : 0u;
    uint place = 0u;
    if (count != 0u) place = atomicAdd(queued, count); // before all writes, which it waits for on CPUs
    CollapseStep found = write_node(tree, args.places, item, children);
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        if (found.leaves[i] == 0u) continue;
        AT(queue, place) = found.items[i];
        place = place + 1u;
    }
}

void main()
{
    if (group_index() >= AT(args.subtree_level, 0).count) return;
    CollapseItem root = load_item(args.subtrees, group_index());
    BuildTree tree = AT(args.trees, root.tree);
    Queue queue = Queue(address_at(args.queues.address, queue_begin(tree.first, root.below), 16u));
    if (gl_LocalInvocationID.x == 0u)
    {
        AT(queue, 0) = root;
        queued = 1u;
    }
    if (LOADS_AHEAD) load_ahead(tree, root);
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
