// SPDX-License-Identifier: MIT
// Turns binary trees into trees of NODE_WIDTH children per node, and writes the records of their leaves.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/collapse.h"
layout(constant_id = NODE_WIDTH_CONSTANT) const uint NODE_WIDTH = 4u;

#ifdef KERNEL_COLLAPSE
// Goes level by level: the items of one level make those of the next, and those of subtrees that a group can do whole.
// Begun once per tree.
layout(local_size_x = COLLAPSE_GROUP) in;
layout(push_constant, scalar) uniform Push { CollapseArgs args; };
layout(constant_id = 0) const uint STEP = COLLAPSE_LEVEL;

// Numbers of items, or positions in their lists, for the next level and for subtrees.
struct ItemLists {
    uint next;
    uint subtrees;
};

bool is_subtree(uint leaves) { return leaves <= args.subtree_leaves; }

void count_item(inout ItemLists counts, uint leaves) {
    if (leaves == 0u) return;
    counts.next += is_subtree(leaves) ? 0u : 1u;
    counts.subtrees += is_subtree(leaves) ? 1u : 0u;
}

// Finds room in a list for `count` more items, `share` of them per group. The invocation that begins its last group so
// far sets its number of groups.
uint reserve(REF(CollapseLevel) list, uint count, uint share) {
    if (count == 0u) return 0u;
    uint begin = atomicAdd(AT(list, 0).count, count);
    uint groups_before = (begin + share - 1u) / share;
    uint groups = (begin + count + share - 1u) / share;
    if (groups == groups_before) return begin;
    atomicMax(AT(list, 0).groups_x, min(groups, GROUPS_PER_ROW));
    atomicMax(AT(list, 0).groups_y, (groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW);
    return begin;
}

ItemLists reserve(ItemLists counts) {
    const uint LEVEL_BYTES = 16u;
    ItemLists ends;
    ends.next =
        reserve(REF(CollapseLevel)(address_after(args.level.address, LEVEL_BYTES)), counts.next, COLLAPSE_GROUP);
    ends.subtrees = reserve(args.subtree_level, counts.subtrees, 1u);
    return ends;
}

void push(CollapseStep found, ItemLists ends) {
    UNROLL for (uint i = 0u; i < NODE_WIDTH; i = i + 1u) {
        if (found.leaves[i] == 0u) continue;
        if (is_subtree(found.leaves[i]))
            store_item(args.subtrees, ends.subtrees, found.items[i]);
        else
            store_item(args.next_items, ends.next, found.items[i]);
        count_item(ends, found.leaves[i]);
    }
}

void begin(uint index) {
    CollapseStep found = begin_collapse(AT(args.trees, index), args.leaf_indices, index, NODE_WIDTH);
    ItemLists counts = ItemLists(0u, 0u);
    count_item(counts, found.leaves[0]);
    push(found, reserve(counts));
}

void do_item(CollapseItem item) {
    BuildTree tree = AT(args.trees, item.tree);
    NodeChildren children = children_of(tree.nodes, item.node_and_level, NODE_WIDTH);
    ItemLists counts = ItemLists(0u, 0u);
    UNROLL for (uint i = 0u; i < NODE_WIDTH; i = i + 1u) count_item(counts, leaves_of_item(children, i));
    ItemLists ends = reserve(counts);  // before all writes, which an atomic operation waits for on CPUs
    push(write_node(tree, args.leaf_indices, item, children, NODE_WIDTH), ends);
}

void main() {
    uint index = global_index();
    uint count = STEP == COLLAPSE_ROOTS ? args.tree_count : AT(args.level, 0).count;
    if (index >= count) return;
    if (STEP == COLLAPSE_ROOTS)
        begin(index);
    else
        do_item(load_item(args.items, index));
}
#endif

#ifdef KERNEL_COLLAPSE_SUBTREES
// Does a subtree per group: items wait in a queue, from which the group takes as many as it has invocations.
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { CollapseArgs args; };

// All invocations of a group see the same contents.
REFERENCE(Queue, coherent, CollapseItem items[], 8)

shared uint queued;  // how many items ever were

void do_item(BuildTree tree, Queue queue, CollapseItem item) {
    NodeChildren children = children_of(tree.nodes, item.node_and_level, NODE_WIDTH);
    uint count = 0u;
    UNROLL for (uint i = 0u; i < NODE_WIDTH; i = i + 1u) count += leaves_of_item(children, i) != 0u ? 1u : 0u;
    uint end = 0u;
    if (count != 0u) end = atomicAdd(queued, count);  // before all writes, which it waits for on CPUs
    CollapseStep found = write_node(tree, args.leaf_indices, item, children, NODE_WIDTH);
    UNROLL for (uint i = 0u; i < NODE_WIDTH; i = i + 1u) {
        if (found.leaves[i] == 0u) continue;
        AT(queue, end) = found.items[i];
        end = end + 1u;
    }
}

void main() {
    if (group_index() >= AT(args.subtree_level, 0).count) return;
    CollapseItem root = load_item(args.subtrees, group_index());
    BuildTree tree = AT(args.trees, root.tree);
    Queue queue = Queue(address_at(args.queues.address,
                                   queue_begin(tree.first, root.descendants + 1u - records_of_node(NODE_WIDTH)), 16u));
    if (gl_LocalInvocationID.x == 0u) {
        AT(queue, 0) = root;
        queued = 1u;
    }
    uint begin = 0u;
    for (;;) {
        memoryBarrierBuffer();
        barrier();
        uint end = min(begin + gl_WorkGroupSize.x, queued);
        if (begin == end) return;
        barrier();  // all have read it before any adds to it
        memoryBarrierBuffer();
        uint mine = begin + gl_LocalInvocationID.x;
        if (mine < end) do_item(tree, queue, AT(queue, mine));
        begin = end;
    }
}
#endif

#ifdef KERNEL_ENCODE_RECORDS
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main() {
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    BuildTree tree = AT(args.trees, chunk.tree);
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += gl_WorkGroupSize.x) {
        uint position = chunk.first + i;
        store_record(tree.records, AT(args.codes, position), encode_leaf(tree, AT(args.order, position) - tree.first));
    }
}
#endif
