// SPDX-License-Identifier: MIT
// Counts each digit in each block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/engine/sort_columns.glsl"
layout(push_constant, scalar) uniform Push { SortArgs args; };

void main()
{
    if (group_index() >= args.block_count) return;
    uint begin = run_begin(args);
    count_digits(args, begin, min(begin + args.run, args.count));
    Uints kept = kept_columns(args);
    bool keeps = keeps_columns(args);
    for (uint digit = gl_LocalInvocationID.x; digit < DIGITS; digit += THREADS)
    {
        uint sum = 0u;
        for (uint slot = digit * THREADS; slot < (digit + 1u) * THREADS; ++slot)
        {
            if (keeps) AT(kept, slot) = sum;
            sum += columns[slot];
        }
        AT(args.counts, digit * args.block_count + group_index()) = sum;
    }
}
