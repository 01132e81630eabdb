// SPDX-License-Identifier: MIT
// The stack of a traversal: the last entry in a register, as many below it as shared memory has room for at full
// occupancy. Where more are pushed the lowest are overwritten, and has_lost says so (Laine, "Restart Trail for
// Stackless BVH Traversal", 2010).
//
// Where entries lie is up to whoever includes this: load_entry(slot) and store_entry(slot, entry), slot < stack_size(),
// a power of two.
#ifndef TWINRAY_SHARED_SHORT_STACK_H
#define TWINRAY_SHARED_SHORT_STACK_H
#include "shaders/shared/short_stack_size.h"

const uint NO_STACK_ENTRY = 0u;

// Below `last`, which may be NO_STACK_ENTRY, entries bottom to top - 1, each in the slot of its number modulo
// stack_size().
struct ShortStack
{
    uint last;
    uint top;
    uint bottom;
    bool has_lost; // entries below `bottom`
};

FUNC ShortStack empty_stack(bool has_lost)
{
    ShortStack stack;
    stack.last = NO_STACK_ENTRY;
    stack.top = 0u;
    stack.bottom = 0u;
    stack.has_lost = has_lost;
    return stack;
}

FUNC void push_entry(INOUT(ShortStack) stack, uint entry)
{
    if (stack.last != NO_STACK_ENTRY)
    {
        store_entry(stack.top & (stack_size() - 1u), stack.last);
        stack.top = stack.top + 1u;
        bool is_over = stack.top - stack.bottom > stack_size();
        stack.bottom = is_over ? stack.bottom + 1u : stack.bottom;
        stack.has_lost = stack.has_lost || is_over;
    }
    stack.last = entry;
}

// Fetches the entry below where there is no last one.
FUNC void fetch_last(INOUT(ShortStack) stack)
{
    if (stack.last == NO_STACK_ENTRY && stack.top != stack.bottom)
    {
        stack.top = stack.top - 1u;
        stack.last = load_entry(stack.top & (stack_size() - 1u));
    }
}
#endif
