// SPDX-License-Identifier: MIT
// The Morton codes of leaves, by which they are sorted, and what a second sort by 60-bit codes takes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/splits.h"

#ifdef KERNEL_MORTON
// Computes the code of each leaf's centre within its tree's centroids.
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main() {
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    LeafBox bounds = bounds_of(AT(args.centroids, chunk.tree));
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += gl_WorkGroupSize.x) {
        uint leaf = chunk.first + i;
        LeafBox box = load_box(args.boxes, leaf);
        AT(args.codes, leaf) = is_active(box) ? morton_code(center_of(box), bounds.lo, bounds.hi) : INACTIVE_CODE;
        if (!is_absent(args.tree_of)) AT(args.tree_of, leaf) = chunk.tree;
    }
}
#endif

#ifdef KERNEL_DUPLICATE_CODES
// Counts each tree's leaves that are followed by many others of the same code, and dispatches the second sort if there
// are many.
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { DuplicateCodesArgs push; };
#define args push.build

uint tree_at(uint position) { return is_absent(args.tree_of) ? 0u : AT(args.tree_of, AT(args.order, position)); }

bool begins_duplicates(uint position) {
    if (position + MANY_DUPLICATES >= args.leaf_count) return false;
    uint code = AT(args.codes, position);
    return code != INACTIVE_CODE && code == AT(args.codes, position + MANY_DUPLICATES) &&
           tree_at(position) == tree_at(position + MANY_DUPLICATES);
}

void dispatch_second_sort() {
    AT(args.duplicate_codes, 0).has_low_codes = 1u;
    AT(args.duplicate_codes, 0).leaf_groups[0] = min(push.leaf_groups, GROUPS_PER_ROW);
    AT(args.duplicate_codes, 0).leaf_groups[1] = (push.leaf_groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW;
    AT(args.duplicate_codes, 0).sort_groups[0] = min(push.sort_groups, GROUPS_PER_ROW);
    AT(args.duplicate_codes, 0).sort_groups[1] = (push.sort_groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW;
    AT(args.duplicate_codes, 0).scan_groups[0] = 1u;
}

void count_duplicates(uint position) {
    if (!begins_duplicates(position)) return;
    uint tree = tree_at(position);
    uint leaf_count = AT(args.trees, tree).count;
    if (needs_low_codes(AT(args.duplicates, tree), leaf_count)) return;
    if (needs_low_codes(atomicAdd(AT(args.duplicates, tree), 1u) + 1u, leaf_count)) dispatch_second_sort();
}

void main() {
    uint begin = group_index() * BUILD_GROUP;
    if (begin >= args.leaf_count) return;
    uint end = min(begin + BUILD_GROUP, args.leaf_count);
    for (uint i = begin + gl_LocalInvocationID.x; i < end; i += gl_WorkGroupSize.x) count_duplicates(i);
}
#endif

#ifdef KERNEL_LOW_CODES
// Computes the low code of each leaf's centre; 0 in trees that need none, so that they keep their order.
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main() {
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    if (gl_LocalInvocationIndex >= chunk.count) return;
    uint leaf = chunk.first + gl_LocalInvocationIndex;
    LeafBox box = AT(args.boxes, leaf);
    LeafBox bounds = bounds_of(AT(args.centroids, chunk.tree));
    uint code = is_active(box) ? morton_code_low(center_of(box), bounds.lo, bounds.hi) : INACTIVE_CODE;
    if (!needs_low_codes(AT(args.duplicates, chunk.tree), AT(args.trees, chunk.tree).count)) code = 0u;
    AT(args.low_codes, leaf) = code;
}
#endif

#ifdef KERNEL_GATHER_KEYS
// Gathers keys for sorting leaves once more, in their present order.
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { GatherKeysArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    AT(args.keys, i) = AT(args.values, AT(args.order, i));
}
#endif
