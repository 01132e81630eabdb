// SPDX-License-Identifier: MIT
// Moves each pair to its place. Thread t owns the items t * ITEMS .. in order; a column of counters per thread keeps
// equal digits in that order, which makes the pass stable.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/sort.h"
layout(local_size_x = SORT_DIGITS) in;
layout(push_constant, scalar) uniform Push { SortArgs args; };

shared uint places[SORT_DIGITS * SORT_DIGITS]; // [digit][thread]

void main()
{
    uint thread = gl_LocalInvocationIndex;
    uint block = group_index();
    if (block >= args.block_count) return;
    uint begin = min(block * SORT_BLOCK + thread * SORT_ITEMS_PER_THREAD, args.count);
    uint end = min(begin + SORT_ITEMS_PER_THREAD, args.count);

    for (uint digit = 0u; digit < SORT_DIGITS; ++digit) places[digit * SORT_DIGITS + thread] = 0u;
    for (uint i = begin; i < end; ++i)
        places[((AT(args.keys_in, i) >> args.shift) & (SORT_DIGITS - 1u)) * SORT_DIGITS + thread] += 1u;
    barrier();

    uint place = AT(args.counts, thread * args.block_count + block);
    for (uint t = 0u; t < SORT_DIGITS; ++t)
    {
        uint count = places[thread * SORT_DIGITS + t];
        places[thread * SORT_DIGITS + t] = place;
        place += count;
    }
    barrier();

    for (uint i = begin; i < end; ++i)
    {
        uint key = AT(args.keys_in, i);
        uint slot = ((key >> args.shift) & (SORT_DIGITS - 1u)) * SORT_DIGITS + thread;
        uint to = places[slot];
        places[slot] = to + 1u;
        AT(args.keys_out, to) = key;
        AT(args.values_out, to) = AT(args.values_in, i);
    }
}
