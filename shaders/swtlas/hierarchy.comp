// SPDX-License-Identifier: MIT
// Topology and boxes in one bottom-up pass, after Apetrei, "Fast and Simple Agglomerative LBVH Construction", 2014.
//
// Sorted leaves i and i + 1 are separated by their split: the highest bit in which their codes differ, or, where the
// codes are equal, their low codes, if they are sorted by those, or their positions. A finished range [first, last] is
// joined with the neighbour across the lower of the splits at its ends, and the inner node is named after that split:
//
//     leaf    0    1    2    3            split 1 is the highest: node 1 is the root.
//     code  000  001  100  101            leaf 0 meets leaf 1 at node 0, leaf 2 meets leaf 3 at node 2,
//     split     0    2    0               and [0, 1] meets [2, 3] at node 1.
//
// An invocation has a run of leaves. A range that is to be joined with one to its right waits in the left half of their
// node; within a run the next ranges find it there. Ranges that reach over the ends of their run go up once the run is
// done: of the two that meet at a node the first leaves its own far end in other_bounds[] and stops; the second finds
// it there and goes on with both. A range writes its half of the node before the exchange.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(constant_id = 0) const uint QUALITY = HIERARCHY_FAST;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

// All groups see the same nodes, not through caches of one.
REFERENCE(BvhChildren, coherent, BvhChild items[], 16)
#include "shaders/shared/rotate.h"
#include "shaders/swtlas/sorted_leaves.glsl"

const uint MOST_STEPS = 2u;  // leaves or joins in one turn of a run

struct Range {
    uint first;
    uint last;
    NodeChild top;  // of its tree
};

// The node at a split has both its halves, `top` and `other`, and becomes the top. Returns the rotation that follows.
Rotation join(inout NodeChild top, NodeChild other, uint node, uvec2 split) {
    top = joined_child(top, other, node);
    if (QUALITY == HIERARCHY_HIGH && is_rotated(top)) return rotation_of(node, highest_below(split));
    return no_rotation();
}

// Does the next step of the rotation of `top`.
void rotate_one(BvhChildren nodes, inout Rotation rotation, inout NodeChild top, float scale) {
    rotate_next(nodes, rotation, scale);
    if (rotation.next == NOTHING) top.subtree = subtree_info(leaves_in(top.subtree), height_of(nodes, rotation.node));
}

void join_bottom_up(BuildTree tree, BvhChildren nodes, float scale, Range range) {
    uint tree_last = tree.first + tree.count - 1u;
    while (range.first != tree.first || range.last != tree_last) {
        uvec2 left = split_before(tree, range.first);
        uvec2 right = range.last == tree_last ? TREE_END : split_after(tree, range.last);
        bool joins_right = less64(right, left);
        uint split = joins_right ? range.last : range.first - 1u;
        uint node = split - tree.first;
        put_child(nodes, node, joins_right ? 0u : 1u, range.top);
        memoryBarrierBuffer();
        uint other = atomicExchange(AT(args.other_bounds, split), joins_right ? range.first : range.last);
        if (other == NOTHING) return;
        memoryBarrierBuffer();
        Rotation rotation =
            join(range.top, get_child(nodes, node, joins_right ? 1u : 0u), node, joins_right ? right : left);
        while (rotation.next != NOTHING) rotate_one(nodes, rotation, range.top, scale);
        if (joins_right)
            range.last = other;
        else
            range.first = other;
    }
    finish(tree, range.top);
}

// A run's leaves, begin .. end - 1, and how far it has come.
struct Run {
    uint begin;
    uint end;
    uint base;   // ranges before it are to be joined with some before the run
    uint first;  // the range at hand: its leaves, first .. position,
    uint position;
    NodeChild top;  // its tree
    uvec2 left;     // and the splits beside it
    uvec2 right;
    bool takes_leaf;  // it is still to be begun, with the leaf at `position`
    uint code;        // of the leaf at `position`, then of the one after it
};

Run first_run(BuildTree tree, uint begin, uint end) {
    Run run;
    run.begin = begin;
    run.end = end;
    run.base = begin;
    run.position = begin;
    run.code = AT(args.codes, begin);
    run.takes_leaf = true;
    run.left = split_before(tree, begin);
    return run;
}

void take_leaf(BuildTree tree, inout Run run) {
    uint element = AT(args.order, run.position);
    run.takes_leaf = false;
    run.first = run.position;
    run.top.box = load_box(args.boxes, element);
    run.top.child = LEAF_BIT | ((args.leaves_are_sorted != 0u ? run.position : element) - tree.first);
    run.top.subtree = subtree_info(1u, 0u);
    run.right = TREE_END;
    if (run.position != tree.first + tree.count - 1u) {
        uint next_code = AT(args.codes, run.position + 1u);
        run.right = split_of(tree, run.position, run.code, next_code);
        run.code = next_code;
    }
}

// Joins the range with the one before it, if that is next; otherwise leaves it and takes another leaf.
Rotation advance(BuildTree tree, BvhChildren nodes, inout Run run) {
    if (run.takes_leaf) take_leaf(tree, run);
    if (run.left == TREE_END && run.right == TREE_END) {
        run.position = run.end;
        return no_rotation();
    }
    bool joins_left = less64(run.left, run.right);
    uint node = (joins_left ? run.first - 1u : run.position) - tree.first;
    put_child(nodes, node, joins_left ? 1u : 0u, run.top);
    if (joins_left && run.first != run.base) {
        NodeChild waiting = get_child(nodes, node, 0u);
        uvec2 split = run.left;
        run.first = run.first - leaves_in(waiting.subtree);
        run.left = split_before(tree, run.first);
        return join(run.top, waiting, node, split);
    }
    if (joins_left) run.base = run.position + 1u;
    run.left = run.right;
    run.position = run.position + 1u;
    run.takes_leaf = true;
    return no_rotation();
}

// Joins the run's ranges with those of other runs: the first ones, which wait in right halves, from the left, the
// others, in left ones, from the right.
void join_ranges(BuildTree tree, BvhChildren nodes, float scale, Run run) {
    uint from = run.begin;
    uint to = run.end;
    while (from != to) {
        bool is_first = from != run.base;
        Range range;
        range.top = get_child(nodes, (is_first ? from : to) - 1u - tree.first, is_first ? 1u : 0u);
        uint count = leaves_in(range.top.subtree);
        range.first = is_first ? from : to - count;
        range.last = range.first + count - 1u;
        from = from + (is_first ? count : 0u);
        to = to - (is_first ? 0u : count);
        join_bottom_up(tree, nodes, scale, range);
    }
}

// Builds from the leaves begin .. end - 1. In each turn of the loop an invocation takes some leaves or joins, but stops
// at a node to rotate, and rotates one: where invocations go through a program together, each waits little for the
// others.
void build_run(BuildTree tree, float scale, uint begin, uint end) {
    BvhChildren nodes = BvhChildren(tree.nodes.address);
    Run run = first_run(tree, begin, end);
    Rotation rotation = no_rotation();
    while (run.position != end) {
        for (uint i = 0u; i < MOST_STEPS && run.position != end && rotation.next == NOTHING; ++i)
            rotation = advance(tree, nodes, run);
        if (rotation.next != NOTHING) rotate_one(nodes, rotation, run.top, scale);
    }
    if (begin == tree.first && end == tree.first + tree.count)
        finish(tree, run.top);
    else
        join_ranges(tree, nodes, scale, run);
}

void main() {
    uint runs = BUILD_GROUP / args.leaves_per_invocation;
    uint index = global_index();
    if (index / runs >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, index / runs);
    uint begin = index % runs * args.leaves_per_invocation;
    if (begin >= chunk.count) return;
    LeafBox bounds = bounds_of(AT(args.centroids, chunk.tree));
    has_low_codes = AT(args.duplicate_codes, 0).has_low_codes != 0u;
    build_run(AT(args.trees, chunk.tree), area_scale(bounds.lo, bounds.hi), chunk.first + begin,
              chunk.first + min(begin + args.leaves_per_invocation, chunk.count));
}
