// SPDX-License-Identifier: MIT
// The children of a node of four that a ray has still to visit, as one word: where they lie, and in which order. And the stack
// of those that wait.
#ifndef TWINRAY_SHARED_GROUP_H
#define TWINRAY_SHARED_GROUP_H
#include "shaders/shared/visit.h"

// A group: where the siblings begin (26 bits), and up to three of them to visit, the next one in the lowest bits (2 bits each,
// the last one repeated). No siblings begin at the root, so that no group is one of these.
const uint EMPTY_GROUP = 0u;
const uint BOTTOM = 1u;    // of the stack
const uint IN_WINDOW = 2u; // what comes next lies in a GroupWindow
const uint IN_MEMORY = 3u; // what comes next lies in memory
FUNC uint make_group(uint siblings, uint second, uint third, uint fourth)
{
    return siblings << 6u | fourth << 4u | third << 2u | second;
}
FUNC uint next_of(uint group) { return (group >> 6u) + (group & 3u); }
// Without the next one; EMPTY_GROUP: there is no other.
FUNC uint rest_of(uint group)
{
    bool is_last = ((group ^ group >> 2u) & 3u) == 0u;
    return is_last ? EMPTY_GROUP : (group & 0xfffffff0u) | (group >> 2u & 15u);
}

// What a stack must hold in memory: a node leaves one group at most, so the deepest path of each level, without those that
// HeldGroups and GroupWindow have. Drivers on CPUs clear all of it for each ray, so where there is no top level,
// TWINRAY_GROUP_STACK should be the lesser one.
const uint WINDOW_SIZE = 8u;
const uint GROUP_STACK_SIZE = 2u * DEEPEST_RECORDS - 5u - WINDOW_SIZE;
const uint ONE_LEVEL_STACK_SIZE = DEEPEST_RECORDS - 5u - WINDOW_SIZE;
#ifndef TWINRAY_GROUP_STACK
#define TWINRAY_GROUP_STACK GROUP_STACK_SIZE
#endif

// What is on top of a stack of groups lies in registers, the last one first: most come and go without a trip to the others.
// Registers without an entry hold `below`.
struct HeldGroups
{
    uint first;
    uint second;
    uint third;
    uint fourth;
    uint fifth;
    uint below; // where the entry below these lies: BOTTOM, IN_WINDOW or IN_MEMORY
};

FUNC HeldGroups hold_none(uint below)
{
    HeldGroups held;
    held.first = below;
    held.second = below;
    held.third = below;
    held.fourth = below;
    held.fifth = below;
    held.below = below;
    return held;
}

// Drops the first group if it is EMPTY_GROUP, or puts `pushed` on top if that is not; never both. Once an iteration, and each number from others as
// they still are: drivers on CPUs pay for whatever changes in a loop, and twice for what is needed once it has changed.
FUNC void shift_groups(INOUT(HeldGroups) held, uint pushed)
{
    bool pushes = pushed != EMPTY_GROUP;
    bool drops = held.first == EMPTY_GROUP;
    held.first = drops ? held.second : held.first;
    held.second = drops ? held.third : held.second;
    held.third = drops ? held.fourth : held.third;
    held.fourth = drops ? held.fifth : held.fourth;
    held.fifth = drops ? held.below : held.fifth;
    held.fifth = pushes ? held.fourth : held.fifth;
    held.fourth = pushes ? held.third : held.fourth;
    held.third = pushes ? held.second : held.third;
    held.second = pushes ? held.first : held.second;
    held.first = pushes ? pushed : held.first;
}

// How many groups the stack has after shift_groups(), of `waiting` before.
FUNC uint waiting_after(HeldGroups held, uint pushed, uint waiting)
{
    return waiting + uint(pushed != EMPTY_GROUP) - uint(held.first == EMPTY_GROUP);
}

// The entries below those held, in registers that are found by comparison: drivers on CPUs write and read an array lane by lane.
struct GroupWindow
{
    uint entries[WINDOW_SIZE];
    uint count;
};

FUNC GroupWindow empty_window()
{
    GroupWindow window;
    UNROLL for (uint i = 0u; i < WINDOW_SIZE; i = i + 1u) window.entries[i] = EMPTY_GROUP;
    window.count = 0u;
    return window;
}

FUNC void push_entry(INOUT(GroupWindow) window, uint entry)
{
    UNROLL for (uint i = 0u; i < WINDOW_SIZE; i = i + 1u) window.entries[i] = window.count == i ? entry : window.entries[i];
    window.count = window.count + 1u;
}

FUNC uint pop_entry(INOUT(GroupWindow) window)
{
    uint entry = window.entries[0];
    UNROLL for (uint i = 1u; i < WINDOW_SIZE; i = i + 1u) entry = window.count > i ? window.entries[i] : entry;
    window.count = window.count - 1u;
    return entry;
}

// Before shift_groups() pushes a group: if five are held already, the last of them goes to the window, or if that is full, to `memory`, a
// uint[TWINRAY_GROUP_STACK] that holds `height` entries. A macro, since drivers on CPUs copy an array that is passed to a function, and a
// ray would take twice as long. The innermost condition always holds: it makes the block too long for these drivers to run it for all
// lanes under a mask, which can take a quarter of a ray's time.
#define TWINRAY_MAKE_ROOM(held, window, memory, height, pushed)            \
    if (pushed != EMPTY_GROUP && held.fifth > IN_MEMORY)                   \
    {                                                                      \
        if (window.count == WINDOW_SIZE)                                   \
        {                                                                  \
            if (height < TWINRAY_GROUP_STACK) memory[height] = held.fifth; \
            height = height + 1u;                                          \
            held.below = IN_MEMORY;                                        \
        }                                                                  \
        else                                                               \
        {                                                                  \
            push_entry(window, held.fifth);                                \
            held.below = IN_WINDOW;                                        \
        }                                                                  \
    }

// Whether a group is below those held.
FUNC bool lies_elsewhere(uint group) { return group == IN_WINDOW || group == IN_MEMORY; }

// Fetches `group`, which is held.first, if it lies elsewhere. That a register tells, and no count: drivers on CPUs go through memory
// for all lanes where one enters the block, and so none enters it that is done.
#define TWINRAY_FETCH_GROUP(held, window, memory, height, group)   \
    if (group == IN_WINDOW)                                        \
    {                                                              \
        group = pop_entry(window);                                 \
        held = hold_none(window.count == 0u ? BOTTOM : IN_WINDOW); \
    }                                                              \
    if (group == IN_MEMORY)                                        \
    {                                                              \
        height = height - 1u;                                      \
        group = memory[height];                                    \
        held = hold_none(height == 0u ? IN_WINDOW : IN_MEMORY);    \
    }

// Where the children of a node come in order, the least first (see place_in_order), each with its number in the last two bits;
// NO_ENTRY or more: the ray does not enter it.
struct ChildKeys
{
    uint key0;
    uint key1;
    uint key2;
    uint key3;
};

FUNC void sort_pair(INOUT(uint) a, INOUT(uint) b)
{
    uint less = min(a, b);
    b = max(a, b);
    a = less;
}

FUNC void sort_keys(INOUT(ChildKeys) keys)
{
    sort_pair(keys.key0, keys.key1);
    sort_pair(keys.key2, keys.key3);
    sort_pair(keys.key0, keys.key2);
    sort_pair(keys.key1, keys.key3);
    sort_pair(keys.key1, keys.key2);
}

// All that are entered but the first, of sorted keys, as a group: two at least are entered. `siblings`: where the children begin.
FUNC uint group_of(ChildKeys keys, uint siblings)
{
    uint third = keys.key2 < NO_ENTRY ? keys.key2 : keys.key1;
    return make_group(siblings, keys.key1 & 3u, third & 3u, (keys.key3 < NO_ENTRY ? keys.key3 : third) & 3u);
}
#endif
