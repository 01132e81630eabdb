// SPDX-License-Identifier: MIT
// Trees of all layouts, looked at in one way.
#ifndef TWINRAY_SHARED_NODE_BOXES_H
#define TWINRAY_SHARED_NODE_BOXES_H
#include "shaders/shared/compressed.h"

// The boxes of a node's children as rays meet them, whatever the layout, and where the children are.
struct NodeBoxes
{
    LeafBox box[4];
    uint child[4];
    uint count;
};

FUNC NodeBoxes boxes_in(SwGeometry geometry, uint index)
{
    NodeBoxes node;
    if (is_null(geometry.records))
    {
        BvhNode binary = load_node(geometry.bvh.nodes, index);
        node.box[0].lo = binary.lo0;
        node.box[0].hi = binary.hi0;
        node.box[1].lo = binary.lo1;
        node.box[1].hi = binary.hi1;
        node.child[0] = binary.child0;
        node.child[1] = binary.child1;
        node.count = 2u;
        return node;
    }
    CompressedRecord record = load_record(geometry.records, index);
    node.count = children_in(record);
    for (uint i = 0u; i < node.count; i = i + 1u)
    {
        node.child[i] = first_child_of(record) + i;
        if (!is_null(geometry.record_boxes)) node.box[i] = load_box(geometry.record_boxes, first_child_of(record) + i);
        else node.box[i] = box_in_planes(record, i);
    }
    return node;
}

FUNC bool is_inner_child(SwGeometry geometry, uint child)
{
    if (is_null(geometry.records)) return (child & LEAF_BIT) == 0u;
    return !is_leaf(load_record(geometry.records, child));
}
#endif
