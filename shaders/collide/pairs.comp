// SPDX-License-Identifier: MIT
// Finds the leaves that overlap each query. Within one tree a query begins right of its own leaf, so that each pair is
// found once.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/box_tree.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PairSearchArgs args; };

bool has(uint flag) { return (args.flags & flag) != 0u; }

// Counts them; returns how many there were before, without the high word.
uint count(uint pairs) {
    uint before = atomicAdd(AT(args.total, 0).low, pairs);
    if (before + pairs < before) atomicAdd(AT(args.total, 0).high, 1u);
    return before;
}

void append_pair(uint item, uint other) {
    uint slot = count(1u);
    if (slot >= args.capacity) return;
    bool is_turned = has(SEARCH_WITHIN) && other < item;
    AT(args.first, slot) = is_turned ? other : item;
    AT(args.second, slot) = is_turned ? item : other;
}

void main() {
    uint i = args.query_begin + global_index();
    if (i >= args.query_end) return;
    TreeBox query = AT(args.queries, i);
    if (is_empty(query)) return;
    if (has(SEARCH_ANY) && atomicAdd(AT(args.total, 0).low, 0u) != 0u) return;
    uint end = args.leaf_begin + args.leaf_count;
    uint node = has(SEARCH_WITHIN) ? next_subtree(args.leaf_begin + i) : 1u;
    while (node != 0u && node < end) {
        TreeBox other = AT(args.nodes, node);
        bool meets = overlap(query, other) && !(has(SEARCH_OTHER_GROUPS) && other.group == query.group);
        if (has(SEARCH_COUNT) && meets && node < args.leaf_begin && contains(query, other)) {
            count(other.item);
        } else if (meets && node < args.leaf_begin) {
            node = 2u * node;
            continue;
        } else if (meets && !is_empty(other)) {
            append_pair(query.item, other.item);
            if (has(SEARCH_ANY)) return;
        }
        node = next_subtree(node);
    }
}
