// SPDX-License-Identifier: MIT
// Moves each pair to its place.
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
    uint end = min(begin + args.run, args.count);
    count_digits(args, begin, end);

    uint place = AT(args.counts, thread * args.block_count + block);
    for (uint t = 0u; t < SORT_DIGITS; ++t)
    {
        uint count = columns[thread * SORT_DIGITS + t];
        columns[thread * SORT_DIGITS + t] = place;
        place += count;
    }
    barrier();

    for (uint i = begin; i < end; ++i)
    {
        uint key = AT(args.keys_in, i);
        uint slot = slot_of(args, key);
        uint to = columns[slot];
        columns[slot] = to + 1u;
        AT(args.keys_out, to) = key;
        AT(args.values_out, to) = AT(args.values_in, i);
    }
}
