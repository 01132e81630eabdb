// SPDX-License-Identifier: MIT
// A tree of boxes for finding those that overlap: the complete binary tree over the boxes in Hilbert order. Node 1 is
// the root, nodes 2 n and 2 n + 1 are the children of n, and leaf i is node leaf_begin + i, leaf_begin being the least
// power of two that is not below the count. No links, no stack: the next node follows from a node's number.
#ifndef TWINRAY_COLLIDE_BOX_TREE_H
#define TWINRAY_COLLIDE_BOX_TREE_H
#include "shaders/shared/list.h"
#include "shaders/shared/world_bound.h"

struct TreeBox {
    vec3 min;   // above max: nothing overlaps it
    uint item;  // of an inner node: how many leaves below it are not empty
    vec3 max;
    uint group;  // of an inner node: that of all leaves below it, or MIXED_GROUPS
};
BUFFER_OF(TreeBox, 16);
const uint MIXED_GROUPS = 0xffffffffu;

struct HilbertOrderArgs {
    REF(TreeBox) boxes;
    REF(WorldBoundBits) bits;  // around the centres
    Uints keys;
    Uints order;  // by the finer bits; read for the others
    uint count;
    uint group_count;  // of the kernel that finds the box of the centres
    uint is_coarse;    // codes: 0 of the finer 30 bits, 1 of the others
    uint reserved;
};

struct BoxTreeArgs {
    REF(TreeBox) boxes;
    Uints order;
    REF(TreeBox) nodes;
    uint count;
    uint first;  // of the nodes of a level, which has as many
    uint leaf_begin;
    uint reserved;
};

struct InstanceBoxesArgs {
    REF(InstanceRecord) records;
    REF(TreeBox) boxes;  // written
    uint count;
    uint first_item;
};

const uint SEARCH_WITHIN = 1u;        // queries are the leaves of the tree: each pair once, the lower item first
const uint SEARCH_OTHER_GROUPS = 2u;  // no pairs within a group
const uint SEARCH_ANY = 4u;           // ends soon after the first pair
const uint SEARCH_COUNT = 8u;         // counts alone: a query that contains a node counts all below it at once

struct PairSearchArgs {
    REF(TreeBox) nodes;
    REF(TreeBox) queries;
    Uints first;   // written: the item of the query,
    Uints second;  // and that of the leaf
    REF(ListTotal) total;
    uint query_begin;  // of this dispatch
    uint query_end;
    uint leaf_begin;
    uint leaf_count;
    uint capacity;  // pairs beyond it are counted, not written
    uint flags;
};

FUNC TreeBox empty_tree_box() {
    TreeBox box;
    box.min = vec3(uintBitsToFloat(0x7f800000u));
    box.max = vec3(uintBitsToFloat(0xff800000u));
    box.item = 0u;
    box.group = MIXED_GROUPS;
    return box;
}

FUNC bool is_empty(TreeBox box) { return !(box.min.x <= box.max.x); }

// Returns whether the boxes overlap. They are closed: boxes that touch overlap.
FUNC bool overlap(TreeBox a, TreeBox b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y && a.min.z <= b.max.z &&
           b.min.z <= a.max.z;
}

FUNC bool contains(TreeBox a, TreeBox b) {
    return a.min.x <= b.min.x && b.max.x <= a.max.x && a.min.y <= b.min.y && b.max.y <= a.max.y && a.min.z <= b.min.z &&
           b.max.z <= a.max.z;
}

FUNC TreeBox around(TreeBox a, TreeBox b) {
    TreeBox both;
    both.min = min(a.min, b.min);
    both.max = max(a.max, b.max);
    both.item = 0u;  // known to the caller
    both.group = a.group == b.group ? a.group : MIXED_GROUPS;
    return both;
}

// Returns the centre. It halves first, because the sum might not be finite.
FUNC vec3 center_of(TreeBox box) {
    PRECISE vec3 center = box.min * 0.5f + box.max * 0.5f;
    return center;
}

// Returns the node after `node` and all below it, in depth-first order; 0 after the last.
FUNC uint next_subtree(uint node) {
    uint next = node + 1u;
    while ((next & 1u) == 0u) next = next >> 1u;
    return next == 1u ? 0u : next;
}

// An overflowed bound becomes as large as can be.
FUNC float low_bound(float x) { return x >= -3.402823466e38f ? x : uintBitsToFloat(0xff800000u); }
FUNC float high_bound(float x) { return x <= 3.402823466e38f ? x : uintBitsToFloat(0x7f800000u); }

FUNC TreeBox tree_box(GeometryBox box, uint item, uint group) {
    TreeBox result;
    result.min = vec3(low_bound(box.lo.x), low_bound(box.lo.y), low_bound(box.lo.z));
    result.max = vec3(high_bound(box.hi.x), high_bound(box.hi.y), high_bound(box.hi.z));
    result.item = item;
    result.group = group;
    return result;
}
#endif
