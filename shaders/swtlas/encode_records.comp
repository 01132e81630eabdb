// SPDX-License-Identifier: MIT
// The records of the leaves.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/collapse.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { EncodeRecordsArgs args; };

void main()
{
    BuildBlock block = AT(args.blocks, min(group_index(), args.block_count - 1u));
    BuildTree tree = AT(args.trees, block.tree);
    if (group_index() >= args.block_count) return;
    for (uint i = gl_LocalInvocationID.x; i < block.count; i += gl_WorkGroupSize.x)
    {
        uint position = block.first + i;
        store_record(tree.records, AT(args.places, position), encode_leaf(tree, AT(args.order, position) - tree.first));
    }
}
