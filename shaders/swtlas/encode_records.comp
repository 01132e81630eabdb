// SPDX-License-Identifier: MIT
// The records of the leaves.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/collapse.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { EncodeRecordsArgs args; };

void main()
{
    BuildBlock block = AT(args.blocks, min(group_index(), args.block_count - 1u));
    BuildTree tree = AT(args.trees, block.tree);
    if (group_index() >= args.block_count || gl_LocalInvocationID.x >= block.count) return;
    uint leaf = block.first + gl_LocalInvocationID.x;
    store_record(tree.records, AT(args.places, leaf), encode_leaf(tree, leaf - tree.first));
}
