// SPDX-License-Identifier: MIT The fine code of each leaf's centre within its tree's centroids; 0 in trees that need
// none, so that they keep their order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
#include "shaders/shared/splits.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { FineCodesArgs args; };

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    if (gl_LocalInvocationIndex >= block.count) return;
    uint leaf = block.first + gl_LocalInvocationIndex;
    LeafBox box = AT(args.boxes, leaf);
    LeafBox bounds = bounds_of(AT(args.centroids, block.tree));
    uint code = is_active(box) ? fine_code(center_of(box), bounds.lo, bounds.hi) : INACTIVE_CODE;
    if (!needs_fine_codes(AT(args.crowded, block.tree), AT(args.trees, block.tree).count)) code = 0u;
    AT(args.fine_codes, leaf) = code;
}
