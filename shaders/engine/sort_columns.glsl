// SPDX-License-Identifier: MIT
// Thread t of a group owns a run of the block's items, in order, and a column of counters: equal digits keep their order
// without an atomic.
#ifndef TWINRAY_ENGINE_SORT_COLUMNS_GLSL
#define TWINRAY_ENGINE_SORT_COLUMNS_GLSL
#include "shaders/shared/sort.h"

shared uint columns[SORT_DIGITS * SORT_DIGITS]; // [digit][thread]

uint slot_of(SortArgs args, uint key)
{
    return (key >> args.shift & (SORT_DIGITS - 1u)) * SORT_DIGITS + gl_LocalInvocationIndex;
}

// Counts the digits of this thread's items, begin .. end - 1. All threads of the group call it.
void count_digits(SortArgs args, uint begin, uint end)
{
    for (uint digit = 0u; digit < SORT_DIGITS; ++digit) columns[digit * SORT_DIGITS + gl_LocalInvocationIndex] = 0u;
    for (uint i = begin; i < end; ++i) columns[slot_of(args, AT(args.keys_in, i))] += 1u;
    barrier();
}
#endif
