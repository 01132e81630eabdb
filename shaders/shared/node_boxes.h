// SPDX-License-Identifier: MIT
// Views trees of all layouts in one way: a node has slots; some slots have a child.
#ifndef TWINRAY_SHARED_NODE_BOXES_H
#define TWINRAY_SHARED_NODE_BOXES_H
#include "shaders/shared/compressed.h"

struct AnyNode {
    BvhNode binary;  // of layout bvh2, else:
    CompressedRecord record;
    CompressedRecord second_half;
    ChildSlots slots;
};

FUNC uint slots_of(SwGeometry geometry) { return is_absent(geometry.records) ? 2u : 8u; }

FUNC AnyNode node_of(SwGeometry geometry, uint index) {
    AnyNode node;
    node.slots.first = 0u;
    node.slots.mask = 3u;
    if (is_absent(geometry.records)) {
        node.binary = load_node(geometry.bvh.nodes, index);
        return node;
    }
    node.record = load_record(geometry.records, index);
    node.second_half = second_half_of(geometry.records, index, node.record);
    node.slots = child_slots(node.record, node.second_half);
    return node;
}

FUNC uint child_in(SwGeometry geometry, AnyNode node, uint slot) {
    if (is_absent(geometry.records)) return child_of(node.binary, slot).child;
    return child_index(node.slots, slot);
}

// Returns the box of a child as rays meet it.
FUNC LeafBox box_in(SwGeometry geometry, AnyNode node, uint slot) {
    if (!is_absent(geometry.records)) return box_in_planes(node.record, node.second_half, slot);
    BvhChild child = child_of(node.binary, slot);
    LeafBox box;
    box.lo = child.lo;
    box.hi = child.hi;
    return box;
}

FUNC bool is_inner_child(SwGeometry geometry, uint child) {
    if (is_absent(geometry.records)) return (child & LEAF_BIT) == 0u;
    return !is_leaf(load_record(geometry.records, child));
}
#endif
