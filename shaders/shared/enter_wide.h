// SPDX-License-Identifier: MIT
// Layout compressed8: which children of a node a ray enters, and what of them waits on the stack.
#ifndef TWINRAY_SHARED_ENTER_WIDE_H
#define TWINRAY_SHARED_ENTER_WIDE_H
#include "shaders/shared/enter_compressed.h"
#include "shaders/shared/octant_order.h"

// Children of a node that wait, as the first of two words of an entry (the other is where the children begin): in the
// lowest 8 bits those to visit, in order; then ChildSlots::mask, and the ray's octant.
FUNC uint make_visits(uint in_order, uint slots, uint octant) { return in_order | slots << 8u | octant << 24u; }
FUNC uint octant_in(uint visits) { return visits >> 24u; }
FUNC uint next_slot(uint visits) { return uint(findLSB(visits)) ^ octant_in(visits); }
// Without the next one; EMPTY_NODE_GROUP: there is no other.
FUNC uint rest_of_visits(uint visits)
{
    uint rest = visits & (visits - 1u);
    return (rest & 0xffu) == 0u ? EMPTY_NODE_GROUP : rest;
}
FUNC ChildSlots slots_of_visits(uint visits, uint first)
{
    ChildSlots slots;
    slots.first = first;
    slots.mask = visits >> 8u & 0xffffu;
    return slots;
}

FUNC uint octant_at(CompressedRecord second_half, BoxRay ray)
{
    uint negative = (ray.near_inverse.x < 0.0f ? 1u : 0u) | (ray.near_inverse.y < 0.0f ? 2u : 0u) |
                    (ray.near_inverse.z < 0.0f ? 4u : 0u);
    return octant_of(negative, second_half.a.x >> 16u);
}

// The slots of a half of the node that the ray crosses, from bit 0 on.
FUNC uint slots_crossed(SeenGrid grid, float first, float last)
{
    uint slots = 0u;
    UNROLL for (uint slot = 0u; slot < 4u; slot = slot + 1u)
        slots = slots | (crosses_planes(grid, 8u * slot, first, last) ? 1u << slot : 0u);
    return slots;
}

// The children that the ray enters, as visits; 0: none.
FUNC uint enter_wide(CompressedRecord node, CompressedRecord second_half, BoxRay ray, float t_min, float t_max)
{
    PRECISE float first = t_min * ray.t_scale;
    PRECISE float last = t_max * ray.t_scale;
    SeenGrid grid = grid_of(node, ray);
    uint crossed = slots_crossed(grid, first, last);
    see_planes(grid, second_half, ray);
    crossed = crossed | slots_crossed(grid, first, last) << 4u;
    // Boxes that are not there may be crossed, too: a ray's padding can be wider than the grid.
    uint slots = second_half.a.x & 0xffffu;
    uint octant = octant_at(second_half, ray);
    return make_visits(in_order_of_octant(crossed & slots, octant), slots, octant);
}

// The child in `slot`, and of the others those that come after it: as a traversal that went on to it left them.
FUNC uint visits_from(uint visits, uint slot)
{
    uint bit = 1u << (slot ^ octant_in(visits));
    return (visits & ~((bit << 1u) - 1u)) | bit;
}
#endif
