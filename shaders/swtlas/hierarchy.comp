// SPDX-License-Identifier: MIT
// Topology and boxes in one bottom-up pass: after Apetrei, "Fast and Simple Agglomerative LBVH Construction", 2014.
//
// Sorted leaves i and i + 1 are separated by their split: the highest bit in which their codes differ, or, where the
// codes are equal, their fine codes, if they are sorted by those, or their positions. A finished range [first, last] is joined with the neighbour across the lower of
// the splits at its ends, and the inner node is named after that split:
//
//     leaf    0    1    2    3            split 1 is the highest: node 1 is the root.
//     code  000  001  100  101            leaf 0 meets leaf 1 at node 0, leaf 2 meets leaf 3 at node 2,
//     split     0    2    0               and [0, 1] meets [2, 3] at node 1.
//
// An invocation has a run of leaves. A range that is to be joined with one to its right waits in the left half of their
// node; within a run the next ranges find it there. A range that reaches over the end of its run climbs: of the two that
// meet at a node the first leaves its own far end in meeting[] and stops; the second finds it there and goes on with both.
// A range writes its half of the node before the exchange.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
#include "shaders/shared/splits.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(constant_id = 0) const uint QUALITY = HIERARCHY_FAST;
layout(push_constant, scalar) uniform Push { HierarchyArgs args; };

// The nodes as seen by all groups, not through caches of one; eight words each.
layout(buffer_reference, scalar, buffer_reference_align = 16) coherent buffer NodeWords { uint64_t items[]; };
#include "shaders/shared/rotate.h"

const uint64_t TREE_END = ~0ul; // the split beside the first and the last leaf

struct Range
{
    uint first;
    uint last;
    NodeHalf top; // of its tree
};

bool is_fine; // leaves are sorted by fine codes, too

uint64_t split_of(BuildTree tree, uint position, uint code, uint next_code)
{
    uint difference = 0u;
    if (is_fine && code == next_code)
        difference = AT(args.fine_codes, AT(args.order, position)) ^ AT(args.fine_codes, AT(args.order, position + 1u));
    return make_split(code ^ next_code, difference, position - tree.first);
}
uint64_t split_after(BuildTree tree, uint position)
{
    return split_of(tree, position, AT(args.codes, position), AT(args.codes, position + 1u));
}

// The node at a split has both its halves: `range`, which may be the left one, and `other`.
void join(NodeWords nodes, inout Range range, bool is_left, NodeHalf other, uint node, uint64_t split, float scale)
{
    NodeHalf own = range.top;
    range.top = joined_half(own, other, node);
    if (QUALITY == HIERARCHY_HIGH && is_rotated(range.top))
    {
        uint height = rotate(nodes, node, is_left ? own : other, is_left ? other : own, highest_below(split), scale);
        range.top.below = make_below(leaves_in(range.top.below), height);
    }
}

void finish(BuildTree tree, Range root)
{
    AT(tree.bvh, 0).root = root.top.child;
    AT(tree.bvh, 0).leaf_count = tree.count;
    AT(tree.bvh, 0).lo = root.top.box.lo;
    AT(tree.bvh, 0).hi = root.top.box.hi;
}

void climb(BuildTree tree, NodeWords nodes, float scale, Range range)
{
    uint tree_last = tree.first + tree.count - 1u;
    while (range.first != tree.first || range.last != tree_last)
    {
        uint64_t left = range.first == tree.first ? TREE_END : split_after(tree, range.first - 1u);
        uint64_t right = range.last == tree_last ? TREE_END : split_after(tree, range.last);
        bool joins_right = right < left;
        uint split = joins_right ? range.last : range.first - 1u;
        uint node = split - tree.first;
        put_half(nodes, node, joins_right ? 0u : 1u, range.top);
        memoryBarrierBuffer();
        uint other = atomicExchange(AT(args.meeting, split), joins_right ? range.first : range.last);
        if (other == NOTHING) return;
        memoryBarrierBuffer();
        join(nodes, range, joins_right, get_half(nodes, node, joins_right ? 1u : 0u), node, min(left, right), scale);
        if (joins_right) range.last = other;
        else range.first = other;
    }
    finish(tree, range);
}

// The leaves begin .. end - 1.
void build_run(BuildTree tree, float scale, uint begin, uint end)
{
    NodeWords nodes = NodeWords(uint64_t(tree.nodes));
    uint tree_last = tree.first + tree.count - 1u;
    uint base = begin; // ranges before it have left the run
    uint64_t left = begin == tree.first ? TREE_END : split_after(tree, begin - 1u);
    uint code = AT(args.codes, begin);
    Range range;
    for (uint i = begin; i < end; ++i)
    {
        uint element = AT(args.order, i);
        range.first = i;
        range.last = i;
        range.top.box = load_box(args.boxes, element);
        range.top.child = LEAF_BIT | ((args.leaves_are_sorted != 0u ? i : element) - tree.first);
        range.top.below = make_below(1u, 0u);
        uint64_t right = TREE_END;
        if (i != tree_last)
        {
            uint next_code = AT(args.codes, i + 1u);
            right = split_of(tree, i, code, next_code);
            code = next_code;
        }
        while (range.first != base && left < right)
        {
            uint node = range.first - 1u - tree.first;
            NodeHalf waiting = get_half(nodes, node, 0u);
            uint64_t split = left;
            left = AT(nodes, node * 8u + 4u);
            put_half(nodes, node, 1u, range.top);
            join(nodes, range, false, waiting, node, split, scale);
            range.first = range.first - leaves_in(waiting.below);
        }
        if (left <= right)
        {
            climb(tree, nodes, scale, range);
            base = i + 1u;
        }
        else if (i + 1u != end)
        {
            put_half(nodes, i - tree.first, 0u, range.top);
            AT(nodes, (i - tree.first) * 8u + 4u) = left; // in the half that is still free
        }
        left = right;
    }
    // What is left waits for ranges of the next run.
    for (uint first = end; first != base; first = range.first)
    {
        if (first != end)
        {
            range.top = get_half(nodes, first - 1u - tree.first, 0u);
            range.first = first - leaves_in(range.top.below);
            range.last = first - 1u;
        }
        climb(tree, nodes, scale, range);
    }
}

void main()
{
    uint runs = BUILD_GROUP / args.run;
    uint index = global_index();
    if (index / runs >= args.block_count) return;
    BuildBlock block = AT(args.blocks, index / runs);
    uint begin = index % runs * args.run;
    if (begin >= block.count) return;
    LeafBox bounds = bounds_of(AT(args.centroids, block.tree));
    is_fine = AT(args.crowding, 0).is_fine != 0u;
    build_run(AT(args.trees, block.tree), area_scale(bounds.lo, bounds.hi), block.first + begin,
              block.first + min(begin + args.run, block.count));
}
