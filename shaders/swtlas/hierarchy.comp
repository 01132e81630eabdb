// SPDX-License-Identifier: MIT
// Topology and boxes in one bottom-up pass: after Apetrei, "Fast and Simple Agglomerative LBVH Construction", 2014.
//
// Sorted leaves i and i + 1 are separated by their split: the highest bit in which their codes differ, or, where the
// codes are equal, their positions. A finished range [first, last] is joined with the neighbour across the lower of
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
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { HierarchyArgs args; };

// The nodes as seen by all groups, not through caches of one; eight words each.
layout(buffer_reference, scalar, buffer_reference_align = 16) coherent buffer SharedNodes { uint64_t words[]; };

const uint64_t TREE_END = ~0ul; // the split beside the first and the last leaf

struct Range
{
    uint first;
    uint last;
    LeafBox box;
    uint self; // reference to it, as a child
};

// Larger = separates higher up. Codes decide; positions only between equal codes.
uint64_t split_of(BuildTree tree, uint position, uint code, uint next_code)
{
    uint place = position - tree.first;
    return uint64_t(code ^ next_code) << 32 | uint64_t(place ^ (place + 1u));
}
uint64_t split_after(BuildTree tree, uint position)
{
    return split_of(tree, position, AT(args.codes, AT(args.order, position)), AT(args.codes, AT(args.order, position + 1u)));
}

// Half 0 of a node is its left one, half 1 its right one.
void put_half(SharedNodes nodes, uint node, uint side, Range range)
{
    uint at = node * 8u + side * 4u;
    uvec3 lo = floatBitsToUint(range.box.lo);
    uvec3 hi = floatBitsToUint(range.box.hi);
    nodes.words[at] = WORD(lo.x, lo.y);
    nodes.words[at + 1u] = WORD(lo.z, range.self);
    nodes.words[at + 2u] = WORD(hi.x, hi.y);
    nodes.words[at + 3u] = WORD(hi.z, range.last - range.first + 1u);
}

struct Half
{
    LeafBox box;
    uint self;
    uint leaves;
};
Half get_half(SharedNodes nodes, uint node, uint side)
{
    uint at = node * 8u + side * 4u;
    uint64_t w0 = nodes.words[at], w1 = nodes.words[at + 1u], w2 = nodes.words[at + 2u], w3 = nodes.words[at + 3u];
    Half found;
    found.box.lo = vec3(FLOATS(w0), FLOATS(w1).x);
    found.box.hi = vec3(FLOATS(w2), FLOATS(w3).x);
    found.self = UINTS(w1).y;
    found.leaves = UINTS(w3).y;
    return found;
}

void join(inout Range range, Half other, uint node)
{
    range.box.lo = min(range.box.lo, other.box.lo);
    range.box.hi = max(range.box.hi, other.box.hi);
    range.self = node;
}

void finish(BuildTree tree, Range root)
{
    AT(tree.bvh, 0).root = root.self;
    AT(tree.bvh, 0).leaf_count = tree.count;
    AT(tree.bvh, 0).lo = root.box.lo;
    AT(tree.bvh, 0).hi = root.box.hi;
}

void climb(BuildTree tree, SharedNodes nodes, Range range)
{
    uint tree_last = tree.first + tree.count - 1u;
    while (range.first != tree.first || range.last != tree_last)
    {
        uint64_t left = range.first == tree.first ? TREE_END : split_after(tree, range.first - 1u);
        bool joins_right = range.last != tree_last && split_after(tree, range.last) < left;
        uint split = joins_right ? range.last : range.first - 1u;
        uint node = split - tree.first;
        put_half(nodes, node, joins_right ? 0u : 1u, range);
        memoryBarrierBuffer();
        uint other = atomicExchange(AT(args.meeting, split), joins_right ? range.first : range.last);
        if (other == NOTHING) return;
        memoryBarrierBuffer();
        join(range, get_half(nodes, node, joins_right ? 1u : 0u), node);
        if (joins_right) range.last = other;
        else range.first = other;
    }
    finish(tree, range);
}

// The leaves begin .. end - 1.
void build_run(BuildTree tree, uint begin, uint end)
{
    SharedNodes nodes = SharedNodes(uint64_t(tree.nodes));
    uint tree_last = tree.first + tree.count - 1u;
    uint base = begin; // ranges before it have left the run
    uint64_t left = begin == tree.first ? TREE_END : split_after(tree, begin - 1u);
    uint element = AT(args.order, begin);
    uint code = AT(args.codes, element);
    Range range;
    for (uint i = begin; i < end; ++i)
    {
        range.first = i;
        range.last = i;
        range.box = AT(args.boxes, element);
        range.self = LEAF_BIT | ((args.leaves_are_sorted != 0u ? i : element) - tree.first);
        uint64_t right = TREE_END;
        if (i != tree_last)
        {
            uint last_code = code;
            element = AT(args.order, i + 1u);
            code = AT(args.codes, element);
            right = split_of(tree, i, last_code, code);
        }
        while (range.first != base && left < right)
        {
            uint node = range.first - 1u - tree.first;
            Half waiting = get_half(nodes, node, 0u);
            left = nodes.words[node * 8u + 4u];
            put_half(nodes, node, 1u, range);
            join(range, waiting, node);
            range.first = range.first - waiting.leaves;
        }
        if (left <= right)
        {
            climb(tree, nodes, range);
            base = i + 1u;
        }
        else if (i + 1u != end)
        {
            put_half(nodes, i - tree.first, 0u, range);
            nodes.words[(i - tree.first) * 8u + 4u] = left; // in the half that is still free
        }
        left = right;
    }
    // What is left waits for ranges of the next run.
    for (uint first = end; first != base; first = range.first)
    {
        if (first != end)
        {
            Half waiting = get_half(nodes, first - 1u - tree.first, 0u);
            range.first = first - waiting.leaves;
            range.last = first - 1u;
            range.box = waiting.box;
            range.self = waiting.self;
        }
        climb(tree, nodes, range);
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
    build_run(AT(args.trees, block.tree), block.first + begin, block.first + min(begin + args.run, block.count));
}
