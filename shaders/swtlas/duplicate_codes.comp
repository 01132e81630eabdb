// SPDX-License-Identifier: MIT
// Counts each tree's leaves that are followed by many others of the same code, and dispatches the second sort if there
// are many.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { DuplicateCodesArgs push; };
#define args push.build

uint tree_at(uint position) { return is_absent(args.tree_of) ? 0u : AT(args.tree_of, AT(args.order, position)); }

bool begins_duplicates(uint position)
{
    if (position + MANY_DUPLICATES >= args.leaf_count) return false;
    uint code = AT(args.codes, position);
    return code != INACTIVE_CODE && code == AT(args.codes, position + MANY_DUPLICATES) &&
        tree_at(position) == tree_at(position + MANY_DUPLICATES);
}

void dispatch_second_sort()
{
    AT(args.duplicate_codes, 0).has_low_codes = 1u;
    AT(args.duplicate_codes, 0).leaf_groups[0] = min(push.leaf_groups, GROUPS_PER_ROW);
    AT(args.duplicate_codes, 0).leaf_groups[1] = (push.leaf_groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW;
    AT(args.duplicate_codes, 0).sort_groups[0] = min(push.sort_groups, GROUPS_PER_ROW);
    AT(args.duplicate_codes, 0).sort_groups[1] = (push.sort_groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW;
    AT(args.duplicate_codes, 0).scan_groups[0] = 1u;
}

void count_duplicates(uint position)
{
    if (!begins_duplicates(position)) return;
    uint tree = tree_at(position);
    uint leaf_count = AT(args.trees, tree).count;
    if (needs_low_codes(AT(args.duplicates, tree), leaf_count)) return;
    if (needs_low_codes(atomicAdd(AT(args.duplicates, tree), 1u) + 1u, leaf_count)) dispatch_second_sort();
}

void main()
{
    uint begin = group_index() * BUILD_GROUP;
    if (begin >= args.leaf_count) return;
    uint end = min(begin + BUILD_GROUP, args.leaf_count);
    for (uint i = begin + gl_LocalInvocationID.x; i < end; i += gl_WorkGroupSize.x) count_duplicates(i);
}
