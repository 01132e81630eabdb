// SPDX-License-Identifier: MIT
// Writes the records of the leaves.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/collapse.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    BuildTree tree = AT(args.trees, chunk.tree);
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += gl_WorkGroupSize.x)
    {
        uint position = chunk.first + i;
        store_record(tree.records, AT(args.codes, position), encode_leaf(tree, AT(args.order, position) - tree.first));
    }
}
