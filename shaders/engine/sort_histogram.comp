// SPDX-License-Identifier: MIT
// Counts each digit in each block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/engine/sort_columns.glsl"
layout(local_size_x = SORT_DIGITS) in;
layout(push_constant, scalar) uniform Push { SortArgs args; };

void main()
{
    uint thread = gl_LocalInvocationIndex;
    uint block = group_index();
    if (block >= args.block_count) return;
    uint begin = min((block * SORT_DIGITS + thread) * args.run, args.count);
    count_digits(args, begin, min(begin + args.run, args.count));
    uint sum = 0u;
    for (uint t = 0u; t < SORT_DIGITS; ++t) sum += columns[thread * SORT_DIGITS + t];
    AT(args.counts, thread * args.block_count + block) = sum;
}
