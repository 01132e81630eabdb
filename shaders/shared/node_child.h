// SPDX-License-Identifier: MIT
// Half a node, which is one child: the unit by which a tree grows from the leaves up. In GLSL it comes after
// BvhChildren, the nodes as all groups see them.
#ifndef TWINRAY_SHARED_NODE_CHILD_H
#define TWINRAY_SHARED_NODE_CHILD_H
#include "shaders/shared/build.h"
#include "shaders/shared/surface_area.h"

// One child as stored in its parent, a BvhNode.
struct NodeChild {
    LeafBox box;
    uint child;
    uint subtree;  // as BvhNode::subtree0
};

// The nodes are two halves each, which begin with the even ones.
FUNC NodeChild get_child(BvhChildren nodes, uint node, uint side) {
    BvhChild stored = AT(nodes, node * 2u + side);
    NodeChild found;
    found.box.lo = stored.lo;
    found.box.hi = stored.hi;
    found.child = stored.child;
    found.subtree = stored.subtree;
    return found;
}
FUNC void put_child(BvhChildren nodes, uint node, uint side, NodeChild half_node) {
    BvhChild stored;
    stored.lo = half_node.box.lo;
    stored.child = half_node.child;
    stored.hi = half_node.box.hi;
    stored.subtree = half_node.subtree;
    AT(nodes, node * 2u + side) = stored;
}

// Returns `node` with these two children, as a child.
FUNC NodeChild joined_child(NodeChild a, NodeChild b, uint node) {
    NodeChild both;
    both.box = around_both(a.box, b.box);
    both.child = node;
    both.subtree =
        subtree_info(leaves_in(a.subtree) + leaves_in(b.subtree), 1u + max(height_in(a.subtree), height_in(b.subtree)));
    return both;
}

// Returns the number of nodes on the longest way down from a node, including itself.
FUNC uint height_of(BvhChildren nodes, uint node) {
    return 1u + max(height_in(AT(nodes, node * 2u).subtree), height_in(AT(nodes, node * 2u + 1u).subtree));
}

FUNC bool is_inner(NodeChild half_node) { return (half_node.child & LEAF_BIT) == 0u; }

// Returns half the area of a box, with lengths times `scale`.
FUNC float area_of(LeafBox box, float scale) {
    if (!is_active(box)) return 0.0f;
    PRECISE vec3 size = (box.hi - box.lo) * scale;
    return area_of_sides(size);
}
FUNC float area_around(NodeChild a, NodeChild b, float scale) { return area_of(around_both(a.box, b.box), scale); }
// Returns the scale for trees with leaf centres from lo to hi: areas are then near 1 at most, or 0.
FUNC float area_scale(vec3 lo, vec3 hi) {
    float unit = area_unit(lo, hi);
    return unit > 1e-37f ? 1.0f / min(unit, 8.5070591730234616e+37f) : 0.0f;  // 2^126: its inverse is normal
}
#endif
