// SPDX-License-Identifier: MIT
// Collapses subtrees, a group each: items wait in a queue, from which the group takes as many as it has invocations. Nodes and
// records of a subtree lie side by side, so that a CPU has them in its caches once they are loaded one line after the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/collapse.h"
#include "shaders/swtlas/ahead.glsl"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { CollapseArgs args; };

// Of CollapseItems, two words each, as all invocations of a group see them.
layout(buffer_reference, scalar, buffer_reference_align = 8) coherent buffer QueueWords { uint64_t items[]; };

shared uint queued; // how many items ever were

void put_item(QueueWords queue, uint at, CollapseItem item)
{
    AT(queue, 2u * at) = first_word(item);
    AT(queue, 2u * at + 1u) = second_word(item);
}

CollapseItem get_item(QueueWords queue, uint at) { return item_of(AT(queue, 2u * at), AT(queue, 2u * at + 1u)); }

// Where rotations have moved nodes, these are other ones of the tree.
void load_ahead(BuildTree tree, CollapseItem root)
{
    BvhNode node = load_node(tree.nodes, node_at(root.place));
    uint left = leaves_in(node.below0);
    uint leaves = left + leaves_in(node.below1);
    uint first = node_at(root.place) + 1u - min(left, node_at(root.place) + 1u);
    uint nodes = min(leaves - 1u, tree.count - 1u - first);
    load_lines(uint64_t(tree.nodes) + uint64_t(first) * 64ul, nodes * 64u, gl_WorkGroupSize.x);
    load_lines(uint64_t(tree.records) + uint64_t(root.below) * 40ul, records_below(leaves) * 40u, gl_WorkGroupSize.x);
}

void do_item(BuildTree tree, QueueWords queue, CollapseItem item)
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
        put_item(queue, place, found.items[i]);
        place = place + 1u;
    }
}

void main()
{
    if (group_index() >= AT(args.subtree_level, 0).count) return;
    CollapseItem root = load_item(args.subtrees, group_index());
    BuildTree tree = AT(args.trees, root.tree);
    QueueWords queue = QueueWords(uint64_t(args.queues) + queue_begin(tree.first, root.below) * 16ul);
    if (gl_LocalInvocationID.x == 0u)
    {
        put_item(queue, 0u, root);
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
        if (mine < end) do_item(tree, queue, get_item(queue, mine));
        begin = end;
    }
}
