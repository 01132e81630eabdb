// SPDX-License-Identifier: MIT
// In which order an invocation that has a run of rays traces them. On a CPU the invocations of a group go through their runs
// together, as lanes of a vector, and the rays of one turn take as long as the longest of them: less, the more alike their
// directions are. Each lane sorts its own rays, into slabs by z and each slab by x. Where neighbours have rays of all directions, as at
// a surface that scatters light, those of equal rank then go much the same way, and no lane has to look at another.
#ifndef TWINRAY_SHARED_TURNS_H
#define TWINRAY_SHARED_TURNS_H
#include "shaders/shared/morton.h"
#include "shaders/shared/trace.h"

const uint TURNS = 32u;      // that are sorted together
const uint FEWEST_TURNS = 8u; // for which it pays
const uint SLAB = 8u;        // turns in a slab
const uint TURN_BITS = 5u;
const uint PART_BITS = 13u; // of a component of a direction: sign, exponent and four bits more

// While they are sorted: a key each, in its lowest bits the turn. Indexed by constants alone.
struct TurnKeys
{
    uint key[TURNS];
};

const uint NO_RAY = 0xffffffe0u; // and more: keys of turns that have none

FUNC uint part_of_key(float x) { return ordered_bits(x) >> (32u - PART_BITS); }
FUNC uint turn_key(vec3 direction, uint turn)
{
    return part_of_key(direction.z) << (PART_BITS + TURN_BITS) | part_of_key(direction.x) << TURN_BITS | turn;
}

// A step of a bitonic sort (Batcher, "Sorting networks and their applications", 1968): keys that lie `gap` apart are put in order, the
// lesser first where the place has no bit of `down`.
FUNC void sort_pairs(INOUT(TurnKeys) keys, uint down, uint gap)
{
    UNROLL for (uint i = 0u; i < TURNS; i = i + 1u)
    {
        if ((i & gap) != 0u) continue;
        uint less = min(keys.key[i], keys.key[i + gap]);
        uint more = max(keys.key[i], keys.key[i + gap]);
        bool is_down = (i & down) != 0u;
        keys.key[i] = is_down ? more : less;
        keys.key[i + gap] = is_down ? less : more;
    }
}
// Of each slab by itself.
FUNC void sort_slabs(INOUT(TurnKeys) keys, uint down)
{
    sort_pairs(keys, 2u, 1u);
    sort_pairs(keys, 4u, 2u);
    sort_pairs(keys, 4u, 1u);
    sort_pairs(keys, down, 4u);
    sort_pairs(keys, down, 2u);
    sort_pairs(keys, down, 1u);
}

// From slab to slab x goes back and forth, so that they meet where they are alike.
FUNC uint key_in_slab(uint key, uint place)
{
    const uint X = ((1u << PART_BITS) - 1u) << TURN_BITS;
    uint mirrored = (place & SLAB) != 0u ? X : 0u;
    return key < NO_RAY ? (key & (X | (TURNS - 1u))) ^ mirrored : key;
}

// Turns without a ray come last.
FUNC void sort_turns(INOUT(TurnKeys) keys)
{
    sort_slabs(keys, 8u);
    sort_pairs(keys, 16u, 8u);
    sort_pairs(keys, 16u, 4u);
    sort_pairs(keys, 16u, 2u);
    sort_pairs(keys, 16u, 1u);
    sort_pairs(keys, TURNS, 16u);
    sort_pairs(keys, TURNS, 8u); // slabs have what belongs there, in no order
    UNROLL for (uint i = 0u; i < TURNS; i = i + 1u) keys.key[i] = key_in_slab(keys.key[i], i);
    sort_slabs(keys, TURNS);
}

// Turns in the order in which they are taken, four a word, the first in the lowest bits: an array that is indexed by a variable
// costs such drivers more than a shift.
struct Turns
{
    uint words[TURNS / 4u];
};

FUNC Turns turns_as_given()
{
    Turns turns;
    UNROLL for (uint i = 0u; i < TURNS / 4u; i = i + 1u) turns.words[i] = 0x03020100u + i * 0x04040404u;
    return turns;
}
FUNC Turns turns_in_order(TurnKeys keys)
{
    const uint TURN = TURNS - 1u;
    Turns turns;
    UNROLL for (uint i = 0u; i < TURNS / 4u; i = i + 1u)
        turns.words[i] = (keys.key[4u * i] & TURN) | (keys.key[4u * i + 1u] & TURN) << 8u | (keys.key[4u * i + 2u] & TURN) << 16u |
                         (keys.key[4u * i + 3u] & TURN) << 24u;
    return turns;
}

// The turn to take after `taken` others, which this has told before.
FUNC uint next_turn(INOUT(Turns) turns, uint taken)
{
    uint turn = turns.words[0] & 0xffu;
    turns.words[0] = turns.words[0] >> 8u;
    if ((taken & 3u) == 3u)
        UNROLL for (uint i = 1u; i < TURNS / 4u; i = i + 1u) turns.words[i - 1u] = turns.words[i];
    return turn;
}

// Whether the directions of rays first, first + size, ... in four turns lie within 37 degrees of the first: a camera's do, or those of
// rays to a light. `count`: of all rays.
FUNC bool are_alike(REF(Ray) rays, uint first, uint size, uint count)
{
    const float SQUARED_COSINE = 0.64f;
    vec3 d0 = load_direction(rays, first);
    bool alike = true;
    UNROLL for (uint i = 1u; i < 4u; i = i + 1u)
    {
        vec3 d = load_direction(rays, min(first + i * size, count - 1u));
        float along = dot(d0, d);
        alike = alike && along > 0.0f && along * along > SQUARED_COSINE * dot(d0, d0) * dot(d, d);
    }
    return alike;
}

// The order of `turns` turns, of which turn t has ray first + t * size if that is below `count`; the first is. Hits are begun here in
// the order in which they lie: memory is fetched ahead for what is written so.
FUNC Turns turns_of(TraceArgs args, uint first, uint size, uint turns, uint count)
{
    bool is_given = uint64_t(args.order) != 0ul; // by whoever knows better
    if (is_given || turns < FEWEST_TURNS || are_alike(args.rays, first, size, count)) return turns_as_given();
    TurnKeys keys;
    UNROLL for (uint t = 0u; t < TURNS; t = t + 1u)
    {
        uint ray = first + t * size;
        bool is_there = t < turns && ray < count;
        uint key = turn_key(load_direction(args.rays, is_there ? ray : first), t);
        if (is_there) AT(args.hits, ray).hit = 0u;
        keys.key[t] = is_there ? key : NO_RAY | t;
    }
    sort_turns(keys);
    return turns_in_order(keys);
}

// The number of the ray to trace in turn k of a run of `run` turns that begins at ray `first`, which is asked for from 0 on.
FUNC uint ray_of_turn(INOUT(Turns) turns, TraceArgs args, uint first, uint k, uint run, uint size, uint count)
{
    uint taken = k & (TURNS - 1u);
    if (taken == 0u) turns = turns_of(args, first + k * size, size, min(run - k, TURNS), count);
    return first + (k - taken + next_turn(turns, taken)) * size;
}
#endif
