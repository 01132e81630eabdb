// SPDX-License-Identifier: MIT
// Computes the low code of each leaf's centre within its tree's centroids; 0 in trees that need none, so that they keep
// their order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
#include "shaders/shared/splits.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    if (gl_LocalInvocationIndex >= chunk.count) return;
    uint leaf = chunk.first + gl_LocalInvocationIndex;
    LeafBox box = AT(args.boxes, leaf);
    LeafBox bounds = bounds_of(AT(args.centroids, chunk.tree));
    uint code = is_active(box) ? morton_code_low(center_of(box), bounds.lo, bounds.hi) : INACTIVE_CODE;
    if (!needs_low_codes(AT(args.duplicates, chunk.tree), AT(args.trees, chunk.tree).count)) code = 0u;
    AT(args.low_codes, leaf) = code;
}
