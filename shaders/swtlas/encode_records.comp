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
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    if (gl_LocalInvocationIndex >= block.count) return;
    uint leaf = block.first + gl_LocalInvocationIndex;
    BuildTree tree = AT(args.trees, block.tree);
    store_record(tree.records, AT(args.places, leaf), encode_leaf(tree, leaf - tree.first));
}
