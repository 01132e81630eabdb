// SPDX-License-Identifier: MIT
// Topology and boxes in one bottom-up pass: Apetrei, "Fast and Simple Agglomerative LBVH Construction", 2014.
//
// Sorted leaves i and i + 1 are separated by their split: the highest bit in which their codes differ, or, where the
// codes are equal, their positions. A finished range [first, last] is joined with the neighbour across the lower of
// the splits at its ends, and the inner node is named after that split:
//
//     leaf    0    1    2    3            split 1 is the highest: node 1 is the root.
//     code  000  001  100  101            leaf 0 meets leaf 1 at node 0, leaf 2 meets leaf 3 at node 2,
//     split     0    2    0               and [0, 1] meets [2, 3] at node 1.
//
// Each leaf climbs. Of the two ranges that meet at a node the first leaves its own far end in meeting[] and stops; the
// second finds it there and goes on with both. A range writes its box into the node before the exchange.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { HierarchyArgs args; };

// The nodes as seen by all groups, not through caches of one.
layout(buffer_reference, scalar, buffer_reference_align = 16) coherent buffer SharedNodes { BvhNode items[]; };

// Larger = separates higher up. Codes decide; positions only between equal codes.
uint64_t split_after(BuildTree tree, uint position)
{
    uint a = AT(args.codes, AT(args.order, position));
    uint b = AT(args.codes, AT(args.order, position + 1u));
    return (uint64_t(a ^ b) << 32) | uint64_t((position - tree.first) ^ (position - tree.first + 1u));
}

void climb(BuildTree tree, uint position)
{
    SharedNodes nodes = SharedNodes(uint64_t(AT(tree.bvh, 0).nodes));
    uint tree_last = tree.first + tree.count - 1u;
    uint first = position;
    uint last = position;
    uint element = AT(args.order, position);
    LeafBox box = AT(args.boxes, element);
    uint self = LEAF_BIT | ((args.leaves_are_sorted != 0u ? position : element) - tree.first);
    while (first != tree.first || last != tree_last)
    {
        bool joins_right = first == tree.first || (last != tree_last && split_after(tree, last) < split_after(tree, first - 1u));
        uint split = joins_right ? last : first - 1u;
        uint node = split - tree.first;
        if (joins_right)
        {
            nodes.items[node].lo0 = box.lo;
            nodes.items[node].hi0 = box.hi;
            nodes.items[node].child0 = self;
            nodes.items[node].first = first - tree.first;
        }
        else
        {
            nodes.items[node].lo1 = box.lo;
            nodes.items[node].hi1 = box.hi;
            nodes.items[node].child1 = self;
            nodes.items[node].last = last - tree.first;
        }
        memoryBarrierBuffer();
        uint other = atomicExchange(AT(args.meeting, split), joins_right ? first : last);
        if (other == NOTHING) return;
        memoryBarrierBuffer();
        LeafBox sibling;
        if (joins_right)
        {
            last = other;
            sibling.lo = nodes.items[node].lo1;
            sibling.hi = nodes.items[node].hi1;
        }
        else
        {
            first = other;
            sibling.lo = nodes.items[node].lo0;
            sibling.hi = nodes.items[node].hi0;
        }
        box.lo = min(box.lo, sibling.lo);
        box.hi = max(box.hi, sibling.hi);
        self = node;
    }
    AT(tree.bvh, 0).root = self;
    AT(tree.bvh, 0).leaf_count = tree.count;
    AT(tree.bvh, 0).lo = box.lo;
    AT(tree.bvh, 0).hi = box.hi;
}

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    if (gl_LocalInvocationIndex >= block.count) return;
    climb(AT(args.trees, block.tree), block.first + gl_LocalInvocationIndex);
}
