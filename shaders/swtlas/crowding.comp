// SPDX-License-Identifier: MIT
// Counts the leaves in crowds, and has the second sort dispatched where they are many.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { CrowdingArgs args; };

shared uint crowded[gl_WorkGroupSize.x];

bool begins_crowd(uint position)
{
    if (position + CROWD >= args.count) return false;
    uint code = AT(args.codes, position);
    if (code == INACTIVE_CODE || code != AT(args.codes, position + CROWD)) return false;
    if (uint64_t(args.tree_of) == 0ul) return true;
    return AT(args.tree_of, AT(args.order, position)) == AT(args.tree_of, AT(args.order, position + CROWD));
}

void decide()
{
    const uint GROUPS_PER_ROW = 32768u;
    AT(args.crowding, 0).is_fine = 1u;
    AT(args.crowding, 0).leaf_groups[0] = min(args.leaf_groups, GROUPS_PER_ROW);
    AT(args.crowding, 0).leaf_groups[1] = (args.leaf_groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW;
    AT(args.crowding, 0).sort_groups[0] = min(args.sort_groups, GROUPS_PER_ROW);
    AT(args.crowding, 0).sort_groups[1] = (args.sort_groups + GROUPS_PER_ROW - 1u) / GROUPS_PER_ROW;
    AT(args.crowding, 0).scan_groups[0] = 1u;
}

void main()
{
    uint groups = (args.count + BUILD_GROUP - 1u) / BUILD_GROUP;
    if (group_index() >= groups) return;
    uint thread = gl_LocalInvocationID.x;
    uint own = 0u;
    uint end = min((group_index() + 1u) * BUILD_GROUP, args.count);
    for (uint i = group_index() * BUILD_GROUP + thread; i < end; i += gl_WorkGroupSize.x) own += begins_crowd(i) ? 1u : 0u;
    crowded[thread] = own;
    barrier();
    if (thread != 0u) return;
    for (uint i = 1u; i < gl_WorkGroupSize.x; ++i) own += crowded[i];
    atomicAdd(AT(args.crowding, 0).crowded, own);
    memoryBarrierBuffer();
    if (atomicAdd(AT(args.crowding, 0).groups_done, 1u) + 1u != groups) return;
    memoryBarrierBuffer();
    if (needs_fine_codes(atomicAdd(AT(args.crowding, 0).crowded, 0u), args.count)) decide();
}
