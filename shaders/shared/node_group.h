// SPDX-License-Identifier: MIT
// The children of a node that a ray has still to visit, in order, as one word: an entry of the stack.
#ifndef TWINRAY_SHARED_NODE_GROUP_H
#define TWINRAY_SHARED_NODE_GROUP_H
#include "shaders/shared/visit.h"

// Where the siblings begin (26 bits), and up to three of them to visit, the next one in the lowest bits (2 bits each,
// the last one repeated). No siblings begin at the root, so that no group is EMPTY_NODE_GROUP.
const uint EMPTY_NODE_GROUP = 0u;
FUNC uint make_node_group(uint siblings, uint second, uint third, uint fourth)
{
    return siblings << 6u | fourth << 4u | third << 2u | second;
}
FUNC uint next_of(uint group) { return (group >> 6u) + (group & 3u); }
// Without the next one; EMPTY_NODE_GROUP: there is no other.
FUNC uint rest_of(uint group)
{
    bool is_last = ((group ^ group >> 2u) & 3u) == 0u;
    return is_last ? EMPTY_NODE_GROUP : (group & 0xfffffff0u) | (group >> 2u & 15u);
}

// Where the children of a node come in order, the least first (see visit_order), each with its number in the last
// two bits; NO_ENTRY or more: the ray does not enter it.
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

// All that are entered but the first, of sorted keys, as a group. `siblings`: where the children begin.
FUNC uint node_group_of(ChildKeys keys, uint siblings)
{
    if (keys.key1 >= NO_ENTRY) return EMPTY_NODE_GROUP;
    uint third = keys.key2 < NO_ENTRY ? keys.key2 : keys.key1;
    return make_node_group(siblings, keys.key1 & 3u, third & 3u, (keys.key3 < NO_ENTRY ? keys.key3 : third) & 3u);
}

FUNC uint key_of(ChildKeys keys, uint child)
{
    uint low = child == 0u ? keys.key0 : keys.key1;
    uint high = child == 2u ? keys.key2 : keys.key3;
    return child < 2u ? low : high;
}

// `child` first, and then those that come after it: as a traversal that went on to it left them.
FUNC uint key_from(uint key, uint first, uint number, uint child)
{
    return number == child ? child : (key > first ? key : NO_ENTRY);
}
FUNC ChildKeys keys_from(ChildKeys keys, uint child)
{
    uint first = key_of(keys, child);
    keys.key0 = key_from(keys.key0, first, 0u, child);
    keys.key1 = key_from(keys.key1, first, 1u, child);
    keys.key2 = key_from(keys.key2, first, 2u, child);
    keys.key3 = key_from(keys.key3, first, 3u, child);
    return keys;
}
#endif
