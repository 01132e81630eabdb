// SPDX-License-Identifier: MIT
// Turns a binary tree into nodes of four or eight children, `width`. The places of a subtree's records follow from the
// numbers of its leaves and of those before it, so that the result does not depend on the order in which invocations
// run.
//
// A node replaces two levels of the binary tree wherever that is necessary for no path to have more than
// DEEPEST_RECORDS of them, and elsewhere those with the largest boxes. With eight children small subtrees go first, so
// that few nodes are nearly empty (see record_count).
#ifndef TWINRAY_SHARED_COLLAPSE_H
#define TWINRAY_SHARED_COLLAPSE_H
#include "shaders/shared/encode_node.h"

// An inner node that becomes a node of records.
struct CollapseItem {
    uint tree;
    uint node_and_level;
    uint record;       // its index
    uint descendants;  // the start of the records below it
};
BUFFER_OF(CollapseItem, 8);

FUNC CollapseItem load_item(REF(CollapseItem) items, uint index) { return AT(items, index); }
FUNC void store_item(REF(CollapseItem) items, uint index, CollapseItem item) { AT(items, index) = item; }

// How many items a level has; begins with the data that an indirect dispatch reads.
struct CollapseLevel {
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint count;
};
BUFFER_OF(CollapseLevel, 4);

// Packs a node of the binary tree, and how many nodes of records are above the one that it becomes.
FUNC uint pack_node(uint node, uint level) { return node | level << 25u; }
FUNC uint node_in(uint node_and_level) { return node_and_level & 0x1ffffffu; }
FUNC uint level_in(uint node_and_level) { return node_and_level >> 25u; }

const uint COLLAPSE_GROUP = 64u;

// Specialisations of the kernel.
const uint COLLAPSE_ROOTS = 0u;  // makes the items of the roots
const uint COLLAPSE_LEVEL = 1u;  // does a level and makes the items of the next

// Items of subtrees that are small enough for a group leave the levels, and wait for collapse_subtrees.
struct CollapseArgs {
    REF(BuildTree) trees;
    REF(CollapseItem) items;
    REF(CollapseItem) next_items;
    REF(CollapseItem) subtrees;
    REF(CollapseItem) queues;  // of their groups, see queue_begin
    REF(CollapseLevel) level;  // the next one follows
    REF(CollapseLevel) subtree_level;
    Uints leaf_indices;  // by leaf, as nodes refer to it: the index of its record
    uint tree_count;
    uint subtree_leaves;  // a subtree has at most
};

// Returns the start of a subtree's queue. The queue has room for the subtree's nodes, half as many as it has records
// below it at most. `before` is the first record below it, less the second half of the root, if that has one. With the
// number of leaves and 0 it is the end of all.
FUNC uint queue_begin(uint tree_first, uint before) {
    return tree_first / 6u * 5u + tree_first % 6u * 5u / 6u + before / 2u;  // 5/6 of it, which 32 bits hold all the way
}

FUNC void set_child(INOUT(NodeChildren) children, uint at, BvhChild set, uint width) {
    UNROLL for (uint i = 0u; i < width; i = i + 1u) {
        bool is_here = i == at;
        children.child[i] = is_here ? set.child : children.child[i];
        children.box[i].lo = is_here ? set.lo : children.box[i].lo;
        children.box[i].hi = is_here ? set.hi : children.box[i].hi;
        children.subtree[i] = is_here ? set.subtree : children.subtree[i];
    }
}

// Splits `node`, child i, into its own two, the second at the end.
FUNC void open_child(REF(BvhNode) nodes, uint node, uint i, INOUT(NodeChildren) children, uint width) {
    BvhNode opened = load_node(nodes, node);
    set_child(children, i, child_of(opened, 0u), width);
    set_child(children, children.count, child_of(opened, 1u), width);
    children.count = children.count + 1u;
}

// Returns the number of levels of the binary tree that may be below the children of a node.
FUNC uint tallest_below(uint level) { return 2u * (DEEPEST_RECORDS - 1u - level); }

// Returns the priority of a child: the one with the most is opened next; below 0: it has no children of its own. It is
// never NaN, so that a node with room has only leaves, on which the bounds of record_count rest. Among eight children,
// subtrees of two or three leaves go first, so that a full node has at most two of them left.
FUNC float priority_of(NodeChildren children, uint i, float unit, uint tallest, uint width) {
    const float SMALL = 3.402823466e+38f;
    const float TALL = 1.701411733e+38f;
    if (i >= children.count || (children.child[i] & LEAF_BIT) != 0u) return -1.0f;
    if (width == 8u && leaves_in(children.subtree[i]) < 4u) return SMALL;
    bool is_too_tall = height_in(children.subtree[i]) > tallest;
    float area = half_area(children.box[i].lo, children.box[i].hi, unit);
    return is_too_tall ? TALL : (area > 0.0f ? area : 0.0f);
}

// Opens a child, if one has children itself.
FUNC void open_next(REF(BvhNode) nodes, float unit, uint tallest, INOUT(NodeChildren) children, uint width) {
    uint next = width;
    uint node = 0u;
    float highest = -1.0f;
    UNROLL for (uint i = 0u; i < width; i = i + 1u) {
        float priority = priority_of(children, i, unit, tallest, width);
        bool is_higher = priority > highest;
        next = is_higher ? i : next;
        node = is_higher ? children.child[i] : node;
        highest = is_higher ? priority : highest;
    }
    if (next < width) open_child(nodes, node, next, children, width);
}

FUNC NodeChildren no_children() {
    NodeChildren children;
    UNROLL for (uint i = 0u; i < 8u; i = i + 1u) {
        children.child[i] = LEAF_BIT;
        children.box[i] = empty_box();
        children.subtree[i] = 0u;
    }
    children.count = 0u;
    return children;
}

// Returns the children of the node that a binary node becomes. It has two levels more than its children may have at
// most, so that none is too tall once two are opened.
FUNC NodeChildren children_of(REF(BvhNode) nodes, uint node_and_level, uint width) {
    NodeChildren children = no_children();
    children.count = 1u;
    open_child(nodes, node_in(node_and_level), 0u, children, width);
    LeafBox around = box_around(children, width);
    float unit = area_unit(around.lo, around.hi);
    uint tallest = tallest_below(level_in(node_and_level));
    for (uint i = 2u; i < width; i = i + 1u) open_next(nodes, unit, tallest, children, width);
    return children;
}

struct CollapseStep {
    CollapseItem items[8];  // of the children
    uint leaves[8];         // below them; 0: there is no item
};

FUNC CollapseStep no_step() {
    CollapseStep step;
    UNROLL for (uint i = 0u; i < 8u; i = i + 1u) step.leaves[i] = 0u;
    return step;
}

FUNC bool is_inner(uint child) { return (child & LEAF_BIT) == 0u; }

// Returns the leaves below child i, if that becomes an item, else 0.
FUNC uint leaves_of_item(NodeChildren children, uint i) {
    return is_inner(children.child[i]) ? leaves_in(children.subtree[i]) : 0u;
}

FUNC NodeOrder order_of(NodeChildren children, uint width) {
    if (width == 8u) return octant_order(children);
    return given_order((1u << children.count) - 1u, 0u);
}

// Writes the node of an item, whose children_of() these are, and the destinations of the leaves among them.
FUNC CollapseStep write_node(BuildTree tree, Uints leaf_indices, CollapseItem item, NodeChildren children, uint width) {
    NodeOrder order = order_of(children, width);
    store_node(tree.records, item.record, encode_node(children, order, item.descendants, width), width);
    ChildSlots of_children;
    of_children.first = item.descendants;
    of_children.mask = order.mask;
    CollapseStep step = no_step();
    uint below = children_end(of_children);
    uint leaves = 0u;
    UNROLL for (uint i = 0u; i < width; i = i + 1u) {
        if (i >= children.count) continue;
        uint index = child_index(of_children, slot_of(order, i));
        leaves = leaves + leaves_in(children.subtree[i]);
        uint child = children.child[i];
        step.leaves[i] = leaves_of_item(children, i);
        if (step.leaves[i] == 0u) {
            AT(leaf_indices, tree.first + (child & ~LEAF_BIT)) = index;
            continue;
        }
        step.items[i].tree = item.tree;
        step.items[i].node_and_level = pack_node(child, level_in(item.node_and_level) + 1u);
        step.items[i].record = index;
        step.items[i].descendants = below;
        below = below + records_below(leaves_in(children.subtree[i]), width);
    }
    for (uint end = item.descendants + records_below(leaves, width); below < end; below = below + 1u)
        store_no_record(tree.records, below);
    return step;
}

// Returns the item of a tree's root, if that is an inner node.
FUNC CollapseStep begin_collapse(BuildTree tree, Uints leaf_indices, uint index, uint width) {
    CollapseStep step = no_step();
    uint root = AT(tree.bvh, 0).root;
    if (root == NOTHING) return step;
    AT(tree.bvh, 0).root = 0u;
    step.leaves[0] = is_inner(root) ? tree.count : 0u;
    step.items[0].tree = index;
    step.items[0].node_and_level = pack_node(root, 0u);
    step.items[0].record = 0u;
    step.items[0].descendants = records_of_node(width);
    if (is_inner(root)) return step;
    AT(leaf_indices, tree.first) = 0u;
    if (width == 8u) store_no_record(tree.records, 1u);
    return step;
}

// Returns the record of a leaf of a tree.
FUNC CompressedRecord encode_leaf(BuildTree tree, uint leaf) {
    if (has_instances(tree)) return encode_instance(leaf);
    Leaf of_tree = leaf_at(tree, leaf);
    return encode_boxed_leaf(tree, of_tree, boxed_leaf(tree, of_tree));
}
#endif
