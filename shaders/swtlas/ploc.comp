// SPDX-License-Identifier: MIT
// Computes topology and boxes in one pass, like hierarchy.comp, but by clusters (shaders/shared/ploc.h). An invocation
// begins with a leaf and goes up the radix tree; of the two that meet at a split the first leaves its own far end in
// other_bounds[] and stops. If the range of the second then has to be merged, the whole group merges it.
//
// Between merges the clusters of a range are in lists by position in the order, where the range begins: their tops,
// NOTHING after the last one if they are fewer than KEPT_CLUSTERS, and their last leaves. Their boxes are those of
// their nodes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

// All groups see the same contents, not through caches of one.
REFERENCE(BvhChildren, coherent, BvhChild items[], 16)
REFERENCE(SharedUints, coherent, uint items[], 4)
#include "shaders/shared/ploc.h"
#include "shaders/swtlas/sorted_leaves.glsl"

// Leaves first .. last, which meet after `split`.
struct Range {
    uint first;
    uint split;
    uint last;
    uint limit;  // of the height of its tree
};

// A merge has its clusters in one half, and those of the next round in the other.
shared Cluster clusters[2u * MOST_CLUSTERS];
shared uint partners[MOST_CLUSTERS];  // each one's choice, itself if it has none
shared uint gone;                     // bits of those that have no place in the next round
shared uint tallest;                  // of the clusters
shared uint waiting;                  // bits of invocations whose range is to be merged
shared Range chosen;                  // the one that is

#define EACH(i, count) (uint i = gl_LocalInvocationID.x; i < count; i += gl_WorkGroupSize.x)

bool is_whole(BuildTree tree, Range range) { return range.last - range.first + 1u == tree.count; }

// Goes up until the range is to be merged. Returns false if another invocation continues with it.
bool traverse_bottom_up(BuildTree tree, inout Range range) {
    while (!is_whole(tree, range)) {
        uvec2 left = split_before(tree, range.first);
        uvec2 right = range.last == tree.first + tree.count - 1u ? TREE_END : split_after(tree, range.last);
        bool joins_right = less64(right, left);
        range.split = joins_right ? range.last : range.first - 1u;
        memoryBarrierBuffer();
        uint other = atomicExchange(AT(args.other_bounds, range.split), joins_right ? range.first : range.last);
        if (other == NOTHING) return false;
        memoryBarrierBuffer();
        range.limit = height_limit(joins_right ? right : left, tree.count);
        if (joins_right)
            range.last = other;
        else
            range.first = other;
        if (range.last - range.first >= KEPT_CLUSTERS) return true;
    }
    return true;
}

// Returns the bits of the invocations that vote for it.
uint votes(bool is_for) {
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationID.x == 0u) waiting = 0u;
    barrier();
    if (is_for) atomicOr(waiting, 1u << gl_LocalInvocationID.x);
    barrier();
    return waiting;
}

NodeChild load_top(BuildTree tree, BvhChildren nodes, uint child) {
    if ((child & LEAF_BIT) == 0u) return joined_child(get_child(nodes, child, 0u), get_child(nodes, child, 1u), child);
    uint leaf = tree.first + (child & ~LEAF_BIT);
    NodeChild top;
    top.box = load_box(args.boxes, args.leaves_are_sorted != 0u ? AT(args.order, leaf) : leaf);
    top.child = child;
    top.subtree = subtree_info(1u, 0u);
    return top;
}

// Returns the place in the next round of the i-th cluster of a round.
uint index_after(uint i) { return i - bitCount(gone & ((1u << i) - 1u)); }
bool is_gone(uint i) { return (gone & 1u << i) != 0u; }
void begin_round() {
    if (gl_LocalInvocationID.x == 0u) gone = 0u;
    barrier();
}

void store_cluster(uint index, Cluster cluster) {
    clusters[index] = cluster;
    atomicMax(tallest, height_in(cluster.top.subtree));
}

// Returns the i-th index of the lists of both parts.
uint list_index(Range range, uint i) {
    return i < KEPT_CLUSTERS ? range.first + i : range.split + 1u + i - KEPT_CLUSTERS;
}

// Loads both parts' clusters and returns their number.
uint load_clusters(BuildTree tree, BvhChildren nodes, Range range) {
    SharedUints tops = SharedUints(args.tops.address);
    memoryBarrierBuffer();
    if (gl_LocalInvocationID.x == 0u) tallest = 0u;
    begin_round();
    for
        EACH(i, MOST_CLUSTERS) {
            uint index = list_index(range, i);
            bool is_within = index <= (i < KEPT_CLUSTERS ? range.split : range.last);
            partners[i] = is_within ? AT(tops, index) : NOTHING;
            if (partners[i] == NOTHING) atomicOr(gone, 1u << i);
        }
    barrier();
    uint count = MOST_CLUSTERS - bitCount(gone);
    for
        EACH(i, MOST_CLUSTERS) {
            if (is_gone(i)) continue;
            Cluster cluster;
            cluster.top = load_top(tree, nodes, partners[i]);
            cluster.last_leaf = AT(SharedUints(args.last_leaves.address), list_index(range, i));
            store_cluster(index_after(i), cluster);
        }
    barrier();
    return count;
}

uint nearest_to(uint i, uint begin, uint count, float scale) {
    NodeChild own = clusters[begin + i].top;
    Nearest nearest = nothing_near(i);
    uint end = min(i + SEARCH_RADIUS + 1u, count);
    for (uint j = i - min(i, SEARCH_RADIUS); j < end; ++j)
        if (j != i) nearest = nearer_of(nearest, i, own, j, clusters[begin + j].top, scale);
    return nearest.cluster;
}

uint lowest_but(uint other, uint begin, uint count) {
    uint lowest = other == 0u ? 1u : 0u;
    for (uint j = lowest + 1u; j < count; ++j) {
        uint height = height_in(clusters[begin + j].top.subtree);
        if (j != other && height < height_in(clusters[begin + lowest].top.subtree)) lowest = j;
    }
    return lowest;
}

// Returns the partner if only the two lowest choose each other.
uint partner_by_height(uint i, uint begin, uint count) {
    uint lowest = lowest_but(NOTHING, begin, count);
    uint next = lowest_but(lowest, begin, count);
    return i == lowest ? next : i == next ? lowest : i;
}

Cluster joined(BvhChildren nodes, Cluster a, Cluster b) {
    Cluster both = joined_cluster(a, b);
    put_child(nodes, both.top.child, 0u, a.top);
    put_child(nodes, both.top.child, 1u, b.top);
    return both;
}

// Merges the clusters from `begin` on. Returns how many are left, in the other half.
uint merge_round(BvhChildren nodes, uint begin, uint count, uint limit, float scale) {
    bool is_free = has_room(tallest, count, limit);
    for
        EACH(i, count)
    partners[i] = is_free ? nearest_to(i, begin, count, scale) : partner_by_height(i, begin, count);
    begin_round();
    for
        EACH(i, count)
    if (partners[i] < i && partners[partners[i]] == i) atomicOr(gone, 1u << i);
    barrier();
    uint left = count - bitCount(gone);
    for
        EACH(i, count) {
            if (is_gone(i)) continue;
            uint partner = partners[i];
            Cluster cluster = clusters[begin + i];
            if (partner > i && partners[partner] == i) cluster = joined(nodes, cluster, clusters[begin + partner]);
            store_cluster((begin ^ MOST_CLUSTERS) + index_after(i), cluster);
        }
    barrier();
    return left;
}

void keep_clusters(Range range, uint begin, uint count) {
    for
        EACH(i, KEPT_CLUSTERS) {
            AT(SharedUints(args.tops.address), range.first + i) = i < count ? clusters[begin + i].top.child : NOTHING;
            if (i < count) AT(SharedUints(args.last_leaves.address), range.first + i) = clusters[begin + i].last_leaf;
        }
    memoryBarrierBuffer();
    barrier();
}

void merge(BuildTree tree, float scale, Range range) {
    BvhChildren nodes = BvhChildren(tree.nodes.address);
    bool is_last = is_whole(tree, range);
    uint begin = 0u;
    uint count = load_clusters(tree, nodes, range);
    while (count > (is_last ? 1u : KEPT_CLUSTERS)) {
        count = merge_round(nodes, begin, count, range.limit, scale);
        begin ^= MOST_CLUSTERS;
    }
    if (!is_last)
        keep_clusters(range, begin, count);
    else if (gl_LocalInvocationID.x == 0u)
        finish(tree, clusters[begin].top);
}

// Merges the ranges of those invocations that wait, one after the other.
void merge_all(BuildTree tree, float scale, uint invocations, Range own) {
    for (uint rest = invocations; rest != 0u; rest &= rest - 1u) {
        if (gl_LocalInvocationID.x == uint(findLSB(rest))) chosen = own;
        barrier();
        merge(tree, scale, chosen);
    }
}

Range begin_leaf(BuildTree tree, uint position) {
    uint index = position - tree.first;
    uint leaf = args.leaves_are_sorted != 0u ? index : AT(args.order, position) - tree.first;
    AT(SharedUints(args.tops.address), position) = LEAF_BIT | leaf;
    AT(SharedUints(args.last_leaves.address), position) = index;
    return Range(position, position, position, 0u);
}

void main() {
    uint groups = BUILD_GROUP / gl_WorkGroupSize.x;
    if (group_index() / groups >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index() / groups);
    uint begin = group_index() % groups * gl_WorkGroupSize.x;
    if (begin >= chunk.count) return;
    BuildTree tree = AT(args.trees, chunk.tree);
    LeafBox bounds = bounds_of(AT(args.centroids, chunk.tree));
    float scale = area_scale(bounds.lo, bounds.hi);
    has_low_codes = AT(args.duplicate_codes, 0).has_low_codes != 0u;
    uint leaf = begin + gl_LocalInvocationID.x;
    bool goes_on = leaf < chunk.count;
    Range range = Range(0u, 0u, 0u, 0u);
    if (goes_on) range = begin_leaf(tree, chunk.first + leaf);
    for (;;) {
        goes_on = goes_on && traverse_bottom_up(tree, range);
        uint invocations = votes(goes_on);
        if (invocations == 0u) return;
        merge_all(tree, scale, invocations, range);
        goes_on = goes_on && !is_whole(tree, range);
    }
}
