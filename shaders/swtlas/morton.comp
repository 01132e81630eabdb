// SPDX-License-Identifier: MIT
// Computes the Morton code of each leaf's centre within its tree's centroids.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
#include "shaders/shared/splits.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    LeafBox bounds = bounds_of(AT(args.centroids, chunk.tree));
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += gl_WorkGroupSize.x)
    {
        uint leaf = chunk.first + i;
        LeafBox box = load_box(args.boxes, leaf);
        AT(args.codes, leaf) = is_active(box) ? morton_code(center_of(box), bounds.lo, bounds.hi) : INACTIVE_CODE;
        if (!is_absent(args.tree_of)) AT(args.tree_of, leaf) = chunk.tree;
    }
}
