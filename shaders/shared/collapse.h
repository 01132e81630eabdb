// SPDX-License-Identifier: MIT
// From a binary tree to nodes of four children. Where the records of a subtree go follows from the leaves before it
// alone, so that the result does not depend on the order in which invocations run.
#ifndef TWINRAY_SHARED_COLLAPSE_H
#define TWINRAY_SHARED_COLLAPSE_H
#include "shaders/shared/compressed.h"
#include "shaders/shared/surface_area.h"

// An inner node that becomes a node of four.
struct CollapseItem
{
    uint tree;
    uint node;   // of the binary tree
    uint record; // where it goes
    uint below;  // where the records below it begin
};
BUFFER_OF(CollapseItem, 4);

// How many items a level has; begins with what an indirect dispatch reads.
struct CollapseLevel
{
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint count;
};
BUFFER_OF(CollapseLevel, 4);

// Specialisations of the kernel.
const uint COLLAPSE_ROOTS = 0u; // makes the items of the roots
const uint COLLAPSE_LEVEL = 1u; // does a level and makes the items of the next
const uint COLLAPSE_REST = 2u;  // does all that is left

struct CollapseArgs
{
    REF(BuildTree) trees;
    REF(CollapseItem) items;
    REF(CollapseItem) next_items;
    REF(CollapseLevel) level; // the next one follows
    uint tree_count;
    uint reserved;
};

FUNC void set_child(INOUT(NodeChildren) children, uint i, uint child, vec3 lo, vec3 hi, uint first, uint last)
{
    children.child[i] = child;
    children.box[i].lo = lo;
    children.box[i].hi = hi;
    children.first[i] = first;
    children.last[i] = last;
}

// The child with the largest box of those that have children themselves, or 4.
FUNC uint widest_inner(NodeChildren children, float unit)
{
    uint widest = 4u;
    float largest = -1.0f;
    for (uint i = 0u; i < children.count; i = i + 1u)
    {
        if ((children.child[i] & LEAF_BIT) != 0u) continue;
        float area = half_area(children.box[i].lo, children.box[i].hi, unit);
        widest = area > largest ? i : widest;
        largest = max(area, largest);
    }
    return widest;
}

// Splits `node`, which has place i among the children, into its own two, the second at the end. A binary node has the number
// of the last leaf below its first child (see swtlas/hierarchy.comp).
FUNC void open_child(REF(BvhNode) nodes, uint node, uint i, INOUT(NodeChildren) children)
{
    BvhNode opened = load_node(nodes, node);
    set_child(children, i, opened.child0, opened.lo0, opened.hi0, opened.first, node);
    set_child(children, children.count, opened.child1, opened.lo1, opened.hi1, node + 1u, opened.last);
    children.count = children.count + 1u;
}

// The children of the node of four that a binary node becomes: the largest boxes are opened first.
FUNC NodeChildren children_of(REF(BvhNode) nodes, uint node)
{
    NodeChildren children;
    children.count = 1u;
    open_child(nodes, node, 0u, children);
    float unit = area_unit(min(children.box[0].lo, children.box[1].lo), max(children.box[0].hi, children.box[1].hi));
    for (uint widest = widest_inner(children, unit); children.count < 4u && widest < 4u; widest = widest_inner(children, unit))
        open_child(nodes, children.child[widest], widest, children);
    return children;
}

struct CollapseStep
{
    CollapseItem items[4]; // those of the children that are inner nodes
    uint count;
};

FUNC CompressedRecord encode_leaf(BuildTree tree, uint leaf)
{
    if (uint64_t(tree.triangles) == 0ul) return encode_instance(leaf);
    return encode_primitive(load_triangle(tree.triangles, leaf));
}

// Writes the node of an item and the leaves among its children.
FUNC CollapseStep collapse(BuildTree tree, CollapseItem item)
{
    NodeChildren children = children_of(AT(tree.bvh, 0).nodes, item.node);
    AT(tree.records, item.record) = encode_node(children, item.below);
    CollapseStep step;
    step.count = 0u;
    uint below = item.below + children.count;
    for (uint i = 0u; i < children.count; i = i + 1u)
    {
        uint child = children.child[i];
        if ((child & LEAF_BIT) != 0u)
        {
            AT(tree.records, item.below + i) = encode_leaf(tree, child & ~LEAF_BIT);
            continue;
        }
        step.items[step.count].tree = item.tree;
        step.items[step.count].node = child;
        step.items[step.count].record = item.below + i;
        step.items[step.count].below = below;
        step.count = step.count + 1u;
        below = below + records_below(children.last[i] - children.first[i] + 1u);
    }
    return step;
}

// The whole of a tree that is no inner node, and nothing; or the item of its root.
FUNC CollapseStep begin_collapse(BuildTree tree, uint index)
{
    CollapseStep step;
    step.count = 0u;
    uint root = AT(tree.bvh, 0).root;
    if (root == NOTHING) return step;
    if ((root & LEAF_BIT) != 0u)
    {
        AT(tree.records, 0) = encode_leaf(tree, root & ~LEAF_BIT);
        return step;
    }
    step.items[0].tree = index;
    step.items[0].node = root;
    step.items[0].record = 0u;
    step.items[0].below = 1u;
    step.count = 1u;
    return step;
}
#endif
