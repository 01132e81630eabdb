// SPDX-License-Identifier: MIT
// Makes new records for an old topology: first the node above each record, then the records. The slots of a tree are
// distributed among the blocks of its leaves.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/collapse.h"
layout(push_constant, scalar) uniform Push { RefitArgs args; };
layout(constant_id = NODE_WIDTH_CONSTANT) const uint NODE_WIDTH = 4u;

uint slots_begin(BuildTree tree, LeafChunk chunk) { return record_count(chunk.first - tree.first, NODE_WIDTH); }
uint slots_end(BuildTree tree, LeafChunk chunk) {
    return record_count(chunk.first - tree.first + chunk.count, NODE_WIDTH);
}

#ifdef KERNEL_RECORD_PARENTS
layout(local_size_x = BUILD_GROUP) in;

void visit(BuildTree tree, uint slot) {
    uint base = 2u * tree.first;
    if (slot == 0u) AT(args.parents, base) = NOTHING;
    CompressedRecord record = load_record(tree.records, slot);
    if (is_leaf(record)) return;
    AT(args.missing, base + slot) = children_in(record);
    if (children_in(record) == 0u) return;
    ChildSlots slots = child_slots(record, second_half_of(tree.records, slot, record));
    DONT_UNROLL for (uint i = 0u; i < NODE_WIDTH; ++i) if (has_child(slots, i))
        AT(args.parents, base + child_index(slots, i)) = slot;
}

void main() {
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    BuildTree tree = AT(args.trees, chunk.tree);
    for (uint slot = slots_begin(tree, chunk) + gl_LocalInvocationIndex; slot < slots_end(tree, chunk);
         slot += BUILD_GROUP)
        visit(tree, slot);
}
#endif

#ifdef KERNEL_REFIT_RECORDS
// Each invocation has a run of slots, whose leaves it refits one after the other; the last child of a node to be
// refitted continues with the node.
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;

// All groups see the same boxes, not through caches of one.
REFERENCE(SharedBoxes, coherent, LeafBox items[], 8)

LeafBox refit_leaf(BuildTree tree, uint slot, CompressedRecord record) {
    if (has_instances(tree)) return AT(args.boxes, tree.first + index_in(record));
    Leaf leaf = leaf_of(record);
    BoxedLeaf boxed = boxed_leaf(tree, leaf);
    store_record(tree.records, slot, encode_boxed_leaf(tree, leaf, boxed));
    return boxed.box;
}

LeafBox refit_node(BuildTree tree, uint slot, SharedBoxes boxes) {
    CompressedRecord node = load_record(tree.records, slot);
    CompressedRecord second_half = second_half_of(tree.records, slot, node);
    ChildSlots slots = child_slots(node, second_half);
    NodeChildren children;
    children.count = NODE_WIDTH;
    UNROLL for (uint i = 0u; i < NODE_WIDTH; ++i) {
        children.box[i] = empty_box();
        if (has_child(slots, i)) children.box[i] = AT(boxes, 2u * tree.first + child_index(slots, i));
    }
    NodeOrder order = given_order(slots.mask, NODE_WIDTH == 8u ? second_half.a.x >> 16u : 0u);
    store_node(tree.records, slot, encode_node(children, order, slots.first, NODE_WIDTH), NODE_WIDTH);
    return box_around(children, NODE_WIDTH);
}

// Stores the box for the record's parent. Returns the parent if this was the last of its children, else NOTHING.
uint leave(BuildTree tree, uint slot, LeafBox box) {
    uint base = 2u * tree.first;
    uint parent = AT(args.parents, base + slot);
    if (parent == NOTHING) {
        AT(tree.bvh, 0).lo = box.lo;
        AT(tree.bvh, 0).hi = box.hi;
        return NOTHING;
    }
    AT(SharedBoxes(args.slot_boxes.address), base + slot) = box;
    memoryBarrierBuffer();
    if (atomicAdd(AT(args.missing, base + parent), 0xffffffffu) != 1u) return NOTHING;
    memoryBarrierBuffer();
    return parent;
}

void main() {
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    BuildTree tree = AT(args.trees, chunk.tree);
    SharedBoxes boxes = SharedBoxes(args.slot_boxes.address);
    uint last = slots_end(tree, chunk);
    uint run = (last - slots_begin(tree, chunk) + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    uint next = min(slots_begin(tree, chunk) + gl_LocalInvocationID.x * run, last);
    uint end = min(next + run, last);
    for (uint slot = next; slot < end; ++slot) {
        CompressedRecord record = load_record(tree.records, slot);
        if (!is_leaf(record)) continue;
        uint node = leave(tree, slot, refit_leaf(tree, slot, record));
        while (node != NOTHING) node = leave(tree, node, refit_node(tree, node, boxes));
    }
}
#endif
