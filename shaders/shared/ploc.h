// SPDX-License-Identifier: MIT
// Clusters of leaves that a tree is joined from, nearest neighbours first (Benthin, Meister, Barczak, Mehalwal, Tsakok,
// Kensler, "H-PLOC: Hierarchical Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction",
// 2024).
//
// Each range of the radix tree over the Morton codes that has more than KEPT_CLUSTERS leaves takes over the clusters of
// its two parts, in order, and joins them in rounds until it has no more than that; the whole tree's, until one is
// left. In a round each cluster chooses the one, among those near it in order, with which it has the smallest joint
// box, and two that choose each other become one in the earlier one's place.
//
// A cluster owns the number of its last leaf. Two that are joined give the lower of theirs to their node and keep the
// higher, so that which number a node has follows from the input alone, and the highest is not used, as there are one
// fewer nodes than leaves. Clusters need not be runs of leaves.
#ifndef TWINRAY_SHARED_PLOC_H
#define TWINRAY_SHARED_PLOC_H
#include "shaders/shared/node_child.h"
#include "shaders/shared/splits.h"

const uint KEPT_CLUSTERS = 16u;  // of a range, at most, for the one above it
const uint MOST_CLUSTERS = 2u * KEPT_CLUSTERS;
const uint SEARCH_RADIUS = 8u;  // how far apart in order two clusters may be that are joined

struct Cluster {
    NodeChild top;
    uint last_leaf;  // position of one of its leaves in the tree's order
};

// A cluster's best partner so far among those near it.
struct Nearest {
    uint cluster;
    float area;  // of the joint box
    uint rank;   // of the pair, among those of equal area
};

// Ranks pairs of equal area: the pair whose clusters are closer in order comes first, then the one that begins at an
// even position: clusters that are all alike are joined two by two. Because no two pairs are equal, the first of all
// pairs is chosen by both, and each round has one.
FUNC uint pair_rank(uint i, uint j) {
    uint first = min(i, j);
    return (max(i, j) - first) << 6u | (first & 1u) << 5u | first;
}

FUNC Nearest nothing_near(uint i) {
    Nearest nearest;
    nearest.cluster = i;
    nearest.area = uintBitsToFloat(0x7f800000u);
    nearest.rank = 0u;
    return nearest;
}

// Updates cluster i's nearest with cluster j. Areas that are too large for a float are all the same.
FUNC Nearest nearer_of(Nearest nearest, uint i, NodeChild own, uint j, NodeChild other, float scale) {
    const float LARGEST = 3.402823466e+38f;
    float around = area_around(own, other, scale);
    float area = around < LARGEST ? around : LARGEST;
    uint rank = pair_rank(i, j);
    bool is_nearer = area < nearest.area || (area == nearest.area && rank < nearest.rank);
    nearest.cluster = is_nearer ? j : nearest.cluster;
    nearest.area = is_nearer ? area : nearest.area;
    nearest.rank = is_nearer ? rank : nearest.rank;
    return nearest;
}

// Joins two clusters, the earlier first, and names their node.
FUNC Cluster joined_cluster(Cluster a, Cluster b) {
    Cluster both;
    both.top = joined_child(a.top, b.top, min(a.last_leaf, b.last_leaf));
    both.last_leaf = max(a.last_leaf, b.last_leaf);
    return both;
}

// Returns the number of levels that a tree of `count` leaves needs.
FUNC uint levels_for(uint count) { return count < 2u ? 0u : uint(findMSB(count - 1u)) + 1u; }

// Returns the greatest height that the tree of a range with this split may get. Because no two splits on a way down are
// the same, there are enough levels above it. Positions have 25 bits; the bits that a smaller tree does not need are
// left for its clusters.
FUNC uint height_limit(uvec2 split, uint leaf_count) {
    bool is_of_positions = split.y == 0u && split.x >> 25u == 0u;
    return highest_below(split) + (is_of_positions ? 25u - levels_for(leaf_count) : 0u);
}

// Clusters fit under a limit if the sum of 2^height over them is at most 2^limit: joining the two lowest keeps that,
// and in the end there is one within the limit. So does any round that begins with room for a balanced tree over
// clusters which all are one level higher than the tallest; else a round only joins the two lowest.
FUNC bool has_room(uint tallest, uint count, uint limit) { return tallest + 1u + levels_for(count) <= limit; }
#endif
