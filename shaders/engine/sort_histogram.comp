// SPDX-License-Identifier: MIT
// Counts each digit in each block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/sort.h"
layout(local_size_x = SORT_DIGITS) in;
layout(push_constant, scalar) uniform Push { SortArgs args; };

shared uint histogram[SORT_DIGITS];

void main()
{
    uint thread = gl_LocalInvocationIndex;
    uint block = group_index();
    if (block >= args.block_count) return;
    histogram[thread] = 0u;
    barrier();
    for (uint i = 0u; i < SORT_ITEMS_PER_THREAD; ++i)
    {
        uint item = block * SORT_BLOCK + i * SORT_DIGITS + thread;
        if (item < args.count) atomicAdd(histogram[(AT(args.keys_in, item) >> args.shift) & (SORT_DIGITS - 1u)], 1u);
    }
    barrier();
    AT(args.counts, thread * args.block_count + block) = histogram[thread];
}
