// SPDX-License-Identifier: MIT
// Counts each tree's leaves in crowds, and has the second sort dispatched where they are many.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { CrowdingArgs args; };

uint tree_at(uint position) { return is_null(args.tree_of) ? 0u : AT(args.tree_of, AT(args.order, position)); }

bool begins_crowd(uint position)
{
    if (position + CROWD >= args.count) return false;
    uint code = AT(args.codes, position);
    return code != INACTIVE_CODE && code == AT(args.codes, position + CROWD) &&
        tree_at(position) == tree_at(position + CROWD);
}

void dispatch_second_sort()
{
    AT(args.crowding, 0).is_fine = 1u;
    AT(args.crowding, 0).leaf_groups[0] = min(args.leaf_groups, GROUPS_PER_ROW);
    AT(args.crowding, 0).leaf_groups[1] = (args.leaf_groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW;
    AT(args.crowding, 0).sort_groups[0] = min(args.sort_groups, GROUPS_PER_ROW);
    AT(args.crowding, 0).sort_groups[1] = (args.sort_groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW;
    AT(args.crowding, 0).scan_groups[0] = 1u;
}

void count_if_crowd(uint position)
{
    if (!begins_crowd(position)) return;
    uint tree = tree_at(position);
    uint leaf_count = AT(args.trees, tree).count;
    if (needs_fine_codes(AT(args.crowded, tree), leaf_count)) return;
    if (needs_fine_codes(atomicAdd(AT(args.crowded, tree), 1u) + 1u, leaf_count)) dispatch_second_sort();
}

void main()
{
    uint begin = group_index() * BUILD_GROUP;
    if (begin >= args.count) return;
    uint end = min(begin + BUILD_GROUP, args.count);
    for (uint i = begin + gl_LocalInvocationID.x; i < end; i += gl_WorkGroupSize.x) count_if_crowd(i);
}
