// SPDX-License-Identifier: MIT
// Slots of the children of a node of layout compressed8, by where they lie in it, so that a ray finds an order of them,
// near ones first, from the signs of its direction alone (after Ylitie, Karras, Laine, 2017): it visits the slots in
// the order of slot ^ octant.
//
// Bit 2 of a slot tells in which half of the children its child is along the first axis, that along which the node is
// longest; bit 1 in which half of those along the second, bit 0 along the third.
#ifndef TWINRAY_SHARED_OCTANT_ORDER_H
#define TWINRAY_SHARED_OCTANT_ORDER_H
#include "shaders/shared/encode_node.h"

// Three axes, from bit 0 on two bits each, the longest first.
FUNC uint axes_by_length(LeafBox around)
{
    vec3 size = is_active(around) ? around.hi - around.lo : vec3(0.0f);
    uint longest = size.x >= size.y ? (size.x >= size.z ? 0u : 2u) : (size.y >= size.z ? 1u : 2u);
    uint second = longest == 0u ? 1u : 0u;
    uint third = longest == 2u ? 1u : 2u;
    bool is_swapped = size[second] < size[third];
    return longest | (is_swapped ? third : second) << 2u | (is_swapped ? second : third) << 4u;
}
FUNC uint axis_at(uint axes, uint level) { return axes >> 2u * level & 3u; }

// The octant of a direction whose negative entries have their bits set: bit 2 of the first axis.
FUNC uint octant_of(uint negative, uint axes)
{
    return (negative >> axis_at(axes, 0u) & 1u) << 2u | (negative >> axis_at(axes, 1u) & 1u) << 1u |
           (negative >> axis_at(axes, 2u) & 1u);
}

// A bit for each slot, moved to that of slot ^ octant.
FUNC uint in_order_of_octant(uint slots, uint octant)
{
    uint moved = (octant & 1u) != 0u ? (slots & 0x55u) << 1u | (slots >> 1u & 0x55u) : slots;
    moved = (octant & 2u) != 0u ? (moved & 0x33u) << 2u | (moved >> 2u & 0x33u) : moved;
    return (octant & 4u) != 0u ? (moved & 0x0fu) << 4u | (moved >> 4u & 0x0fu) : moved;
}

// Each group of children that share their bits of `slots` so far is split in half along an axis: the bits of the upper
// halves. Of an odd number the lower half is the larger one.
FUNC uint upper_halves(NodeChildren children, uint slots, uint axis)
{
    const float LARGEST_FLOAT = uintBitsToFloat(0x7f7fffffu);
    float center[8];
    UNROLL for (uint i = 0u; i < 8u; i = i + 1u)
    {
        float middle = center_of(children.box[i])[axis];
        center[i] = abs(middle) <= LARGEST_FLOAT ? middle : 0.0f; // NaN of a box without an end
    }
    uint upper = 0u;
    UNROLL for (uint i = 0u; i < 8u; i = i + 1u)
    {
        uint size = 0u;
        uint before = 0u;
        UNROLL for (uint j = 0u; j < 8u; j = j + 1u)
        {
            bool is_with = j < children.count && ((slots >> 4u * i ^ slots >> 4u * j) & 15u) == 0u;
            bool comes_before = j < i ? center[j] <= center[i] : center[j] < center[i];
            size = size + (is_with ? 1u : 0u);
            before = before + (is_with && comes_before ? 1u : 0u);
        }
        upper = upper | (2u * before >= size + (size & 1u) && i < children.count ? 1u << 4u * i : 0u);
    }
    return upper;
}

// Leaves and inner nodes, as in BvhNode.
FUNC NodeOrder octant_order(NodeChildren children)
{
    NodeOrder order;
    order.axes = axes_by_length(box_around(children, 8u));
    order.slots = 0u;
    UNROLL for (uint level = 0u; level < 3u; level = level + 1u)
        order.slots = order.slots | upper_halves(children, order.slots, axis_at(order.axes, level)) << (2u - level);
    order.mask = 0u;
    UNROLL for (uint i = 0u; i < 8u; i = i + 1u)
    {
        uint bits = (children.child[i] & LEAF_BIT) == 0u ? 0x101u : 1u;
        order.mask = order.mask | (i < children.count ? bits << slot_of(order, i) : 0u);
    }
    return order;
}
#endif
