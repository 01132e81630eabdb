// SPDX-License-Identifier: MIT
// The Morton code of each leaf's centre within its tree's centroids.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
#include "shaders/shared/splits.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { MortonArgs args; };

void main()
{
    BuildBlock block = AT(args.blocks, min(group_index(), args.block_count - 1u));
    LeafBox bounds = bounds_of(AT(args.centroids, block.tree));
    if (group_index() >= args.block_count) return;
    for (uint i = gl_LocalInvocationID.x; i < block.count; i += gl_WorkGroupSize.x)
    {
        uint leaf = block.first + i;
        LeafBox box = load_box(args.boxes, leaf);
        uint code = INACTIVE_CODE;
        if (is_active(box))
        {
            code = morton_code(center_of(box), bounds.lo, bounds.hi);
        }
        AT(args.codes, leaf) = code;
        if (!is_null(args.tree_of)) AT(args.tree_of, leaf) = block.tree;
    }
}
