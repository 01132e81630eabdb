// SPDX-License-Identifier: MIT
// From a binary tree to nodes of four children. Where the records of a subtree go follows from the number of its leaves
// and of those before it, so that the result does not depend on the order in which invocations run.
//
// A node takes the place of two levels of the binary tree wherever that must be for no path to have more than
// DEEPEST_RECORDS of them, and where it need not be, of those with the largest boxes.
#ifndef TWINRAY_SHARED_COLLAPSE_H
#define TWINRAY_SHARED_COLLAPSE_H
#include "shaders/shared/compressed.h"
#include "shaders/shared/surface_area.h"

// An inner node that becomes a node of four.
struct CollapseItem
{
    uint tree;
    uint place;  // see make_place
    uint record; // where it goes
    uint below;  // where the records below it begin
};
BUFFER_OF(CollapseItem, 8);

FUNC CollapseItem load_item(REF(CollapseItem) items, uint index) { return AT(items, index); }
FUNC void store_item(REF(CollapseItem) items, uint index, CollapseItem item) { AT(items, index) = item; }

// How many items a level has; begins with what an indirect dispatch reads.
struct CollapseLevel
{
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint count;
};
BUFFER_OF(CollapseLevel, 4);

// A node of the binary tree, and how many nodes of four are above the one that it becomes.
FUNC uint make_place(uint node, uint level) { return node | level << 25u; }
FUNC uint node_at(uint place) { return place & 0x1ffffffu; }
FUNC uint level_at(uint place) { return place >> 25u; }

const uint COLLAPSE_GROUP = 64u;

// Specialisations of the kernel.
const uint COLLAPSE_ROOTS = 0u; // makes the items of the roots
const uint COLLAPSE_LEVEL = 1u; // does a level and makes the items of the next

// Items of subtrees that are small enough for a group leave the levels, and wait for collapse_subtrees.
struct CollapseArgs
{
    REF(BuildTree) trees;
    REF(CollapseItem) items;
    REF(CollapseItem) next_items;
    REF(CollapseItem) subtrees;
    REF(CollapseItem) queues;        // of their groups, see queue_begin
    REF(CollapseLevel) level;        // the next one follows
    REF(CollapseLevel) subtree_level;
    Uints places;                    // by leaf, as nodes refer to it: where its record goes
    uint tree_count;
    uint subtree_leaves;             // a subtree has at most
};

// The queue of a subtree of n leaves takes its (2 n - 1) / 3 nodes at most, half as many as it has records below it:
// where that of the one with records from `below` on begins, and, with the number of leaves and 0, where all end.
FUNC uint queue_begin(uint tree_first, uint below)
{
    return tree_first / 6u * 5u + tree_first % 6u * 5u / 6u + below / 2u; // 5/6 of it, which 32 bits hold all the way
}

FUNC void set_child(INOUT(NodeChildren) children, uint at, uint child, vec3 lo, vec3 hi, uint below)
{
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        bool is_here = i == at;
        children.child[i] = is_here ? child : children.child[i];
        children.box[i].lo = is_here ? lo : children.box[i].lo;
        children.box[i].hi = is_here ? hi : children.box[i].hi;
        children.below[i] = is_here ? below : children.below[i];
    }
}

// Splits `node`, which has place i among the children, into its own two, the second at the end.
FUNC void open_child(REF(BvhNode) nodes, uint node, uint i, INOUT(NodeChildren) children)
{
    BvhNode opened = load_node(nodes, node);
    set_child(children, i, opened.child0, opened.lo0, opened.hi0, opened.below0);
    set_child(children, children.count, opened.child1, opened.lo1, opened.hi1, opened.below1);
    children.count = children.count + 1u;
}

// How many levels of the binary tree may be below the children of a node of four.
FUNC uint tallest_below(uint level) { return 2u * (DEEPEST_RECORDS - 1u - level); }

// Opens a child that is too tall, else the one with the largest box of those that have children themselves, if there is
// one.
FUNC void open_widest(REF(BvhNode) nodes, float unit, uint tallest, INOUT(NodeChildren) children)
{
    const float WIDEST = 3.402823466e+38f;
    uint widest = 4u;
    uint node = 0u;
    float largest = -1.0f;
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        bool is_too_tall = height_in(children.below[i]) > tallest;
        float area = is_too_tall ? WIDEST : half_area(children.box[i].lo, children.box[i].hi, unit);
        bool is_wider = i < children.count && (children.child[i] & LEAF_BIT) == 0u && area > largest;
        widest = is_wider ? i : widest;
        node = is_wider ? children.child[i] : node;
        largest = is_wider ? area : largest;
    }
    if (widest < 4u) open_child(nodes, node, widest, children);
}

FUNC NodeChildren no_children()
{
    NodeChildren children;
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        children.child[i] = LEAF_BIT;
        children.box[i] = empty_box();
        children.below[i] = 0u;
    }
    children.count = 0u;
    return children;
}

// The children of the node of four that a binary node becomes. It has two levels more than its children may have at
// most, so that none is too tall once two are opened.
FUNC NodeChildren children_of(REF(BvhNode) nodes, uint place)
{
    NodeChildren children = no_children();
    children.count = 1u;
    open_child(nodes, node_at(place), 0u, children);
    LeafBox around = box_around(children);
    float unit = area_unit(around.lo, around.hi);
    open_widest(nodes, unit, tallest_below(level_at(place)), children);
    open_widest(nodes, unit, tallest_below(level_at(place)), children);
    return children;
}

struct CollapseStep
{
    CollapseItem items[4]; // of the children
    uint leaves[4];        // below them; 0: there is no item
};

FUNC CollapseStep no_step()
{
    CollapseStep step;
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u) step.leaves[i] = 0u;
    return step;
}

FUNC bool is_inner(uint child) { return (child & LEAF_BIT) == 0u; }

// Below child i, if that becomes an item, else 0.
FUNC uint leaves_of_item(NodeChildren children, uint i)
{
    return is_inner(children.child[i]) ? leaves_in(children.below[i]) : 0u;
}

// Writes the node of an item, whose children_of() these are, and where the leaves among them go.
FUNC CollapseStep write_node(BuildTree tree, Uints places, CollapseItem item, NodeChildren children)
{
    store_record(tree.records, item.record, encode_node(children, item.below));
    CollapseStep step = no_step();
    uint below = item.below + children.count;
    uint leaves = 0u;
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        if (i >= children.count) continue;
        leaves = leaves + leaves_in(children.below[i]);
        keep_box(tree, item.below + i, children.box[i]);
        uint child = children.child[i];
        step.leaves[i] = leaves_of_item(children, i);
        if (step.leaves[i] == 0u)
        {
            AT(places, tree.first + (child & ~LEAF_BIT)) = item.below + i;
            continue;
        }
        step.items[i].tree = item.tree;
        step.items[i].place = make_place(child, level_at(item.place) + 1u);
        step.items[i].record = item.below + i;
        step.items[i].below = below;
        below = below + records_below(leaves_in(children.below[i]));
    }
    for (uint end = item.below + records_below(leaves); below < end; below = below + 1u)
        store_no_record(tree.records, below);
    return step;
}

// The item of a tree's root, if that is an inner node.
FUNC CollapseStep begin_collapse(BuildTree tree, Uints places, uint index)
{
    CollapseStep step = no_step();
    uint root = AT(tree.bvh, 0).root;
    if (root == NOTHING) return step;
    AT(tree.bvh, 0).root = 0u;
    step.leaves[0] = is_inner(root) ? tree.count : 0u;
    step.items[0].tree = index;
    step.items[0].place = make_place(root, 0u);
    step.items[0].record = 0u;
    step.items[0].below = 1u;
    if (!is_inner(root)) AT(places, tree.first) = 0u;
    return step;
}

// The record of a leaf of a tree.
FUNC CompressedRecord encode_leaf(BuildTree tree, uint leaf)
{
    if (has_instances(tree)) return encode_instance(leaf);
    BvhTriangle fetched = fetch_primitive(tree, leaf);
    return encode_primitive(has_boxes(tree) ? fetched : without_inactive_corners(fetched));
}
#endif
