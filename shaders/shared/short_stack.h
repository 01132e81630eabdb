// SPDX-License-Identifier: MIT
// The stack of a traversal: the last entry in registers, as many below it as shared memory has room for at full
// occupancy. Where more are pushed the lowest are overwritten, and `bottom` is not 0 (Laine, "Restart Trail for
// Stackless BVH Traversal", 2010).
//
// Where words lie is up to whoever includes this: load_entry(slot) and store_entry(slot, word), slot < stack_size(), a
// power of two.
#ifndef TWINRAY_SHARED_SHORT_STACK_H
#define TWINRAY_SHARED_SHORT_STACK_H
#include "shaders/shared/short_stack_size.h"

const uint NO_STACK_ENTRY = 0u;

// Below `last`, which may be NO_STACK_ENTRY, entries bottom to top - 1, each in the slot of its number modulo the
// stack's capacity. Those below `bottom` are lost.
struct ShortStack
{
    uint last;
    uint second; // its other word, where entries have two
    uint top;
    uint bottom;
};

// `has_lost`: as if entries had been lost.
FUNC ShortStack empty_stack(bool has_lost)
{
    ShortStack stack;
    stack.last = NO_STACK_ENTRY;
    stack.second = 0u;
    stack.top = has_lost ? 1u : 0u;
    stack.bottom = stack.top;
    return stack;
}

FUNC uint stack_capacity(bool has_two_words) { return has_two_words ? stack_size() / 2u : stack_size(); }

FUNC void push_entry(INOUT(ShortStack) stack, uint entry, uint second, bool has_two_words)
{
    uint capacity = stack_capacity(has_two_words);
    if (stack.last != NO_STACK_ENTRY)
    {
        uint slot = stack.top & (capacity - 1u);
        store_entry(slot, stack.last);
        if (has_two_words) store_entry(slot + capacity, stack.second);
        stack.top = stack.top + 1u;
        bool is_over = stack.top - stack.bottom > capacity;
        stack.bottom = is_over ? stack.bottom + 1u : stack.bottom;
    }
    stack.last = entry;
    if (has_two_words) stack.second = second;
}

// Fetches the entry below where there is no last one.
FUNC void fetch_last(INOUT(ShortStack) stack, bool has_two_words)
{
    if (stack.last == NO_STACK_ENTRY && stack.top != stack.bottom)
    {
        stack.top = stack.top - 1u;
        uint capacity = stack_capacity(has_two_words);
        uint slot = stack.top & (capacity - 1u);
        stack.last = load_entry(slot);
        if (has_two_words) stack.second = load_entry(slot + capacity);
    }
}
#endif
