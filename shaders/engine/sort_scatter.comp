// SPDX-License-Identifier: MIT
// Moves each pair to where its digit goes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/engine/sort_columns.glsl"
layout(constant_id = IOTA_CONSTANT) const bool VALUES_ARE_IOTA = false;
layout(push_constant, scalar) uniform Push { SortArgs args; };

// Computes the destinations of the items of each digit and thread.
void begin_digits()
{
    Uints kept = kept_columns(args);
    bool is_kept = keeps_columns(args);
    for (uint digit = gl_LocalInvocationID.x; digit < DIGITS; digit += THREADS)
    {
        uint next = AT(args.counts, digit * args.block_count + group_index());
        for (uint slot = digit * THREADS; slot < (digit + 1u) * THREADS; ++slot)
        {
            uint count = is_kept ? 0u : columns[slot];
            columns[slot] = is_kept ? next + AT(kept, slot) : next;
            next += count;
        }
    }
    barrier();
}

uint value_at(uint index)
{
    if (VALUES_ARE_IOTA) return index;
    return AT(args.values_in, index);
}

void main()
{
    if (group_index() >= args.block_count) return;
    uint begin = run_begin(args);
    uint end = min(begin + args.run, args.count);
    if (!keeps_columns(args)) count_digits(args, begin, end);
    begin_digits();
    for (uint i = begin; i < end; ++i)
    {
        uint key = AT(args.keys_in, i);
        uint slot = slot_of(args, key);
        uint to = columns[slot];
        columns[slot] = to + 1u;
        AT(args.keys_out, to) = key;
        AT(args.values_out, to) = value_at(i);
    }
}
