// SPDX-License-Identifier: MIT
// Thread t of a group owns a run of the block's items, in order, and a column of counters: equal digits keep their
// order without an atomic.
#ifndef TWINRAY_ENGINE_SORT_COLUMNS_GLSL
#define TWINRAY_ENGINE_SORT_COLUMNS_GLSL
#include "shaders/shared/sort.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(constant_id = DIGIT_BITS_CONSTANT) const uint DIGIT_BITS = SORT_GPU_DIGIT_BITS;

const uint THREADS = gl_WorkGroupSize.x;
const uint DIGITS = 1u << DIGIT_BITS;

shared uint columns[DIGITS * THREADS]; // [digit][thread]

Uints kept_columns(SortArgs args)
{
    return Uints(address_at(args.kept.address, group_index(), DIGITS * THREADS * 4u));
}
bool keeps_columns(SortArgs args) { return !is_absent(args.kept); }

uint slot_of(SortArgs args, uint key)
{
    return (key >> args.shift & (DIGITS - 1u)) * THREADS + gl_LocalInvocationID.x;
}

uint run_begin(SortArgs args) { return min((group_index() * THREADS + gl_LocalInvocationID.x) * args.run, args.count); }

// Counts the digits of this thread's items, begin .. end - 1. All threads of the group call it.
void count_digits(SortArgs args, uint begin, uint end)
{
    for (uint digit = 0u; digit < DIGITS; ++digit) columns[digit * THREADS + gl_LocalInvocationID.x] = 0u;
    for (uint i = begin; i < end; ++i) columns[slot_of(args, AT(args.keys_in, i))] += 1u;
    barrier();
}
#endif
