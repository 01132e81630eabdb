// SPDX-License-Identifier: MIT
// Writes nodes and leaves of layouts of records.
//
// The children of a node of layout compressed8 are in slots by their positions in it, so that a ray finds an order of
// them, near ones first, only from the signs of its direction (after Ylitie, Karras, Laine, 2017): it visits the slots
// in the order of slot ^ octant. Bit 2 of a slot tells in which half of the children its child is along the first axis,
// that along which the node is longest; bit 1 in which half of those along the second, bit 0 along the third.
#ifndef TWINRAY_SHARED_ENCODE_NODE_H
#define TWINRAY_SHARED_ENCODE_NODE_H
#include "shaders/shared/compressed.h"

// Returns the exponent of the smallest power of two by which lo..hi is 252 cells long at most, with what origin_below
// may lie farther off, and a cell some roundings of the coordinates: then what lies a cell below lo, rounded, is 1/2 to
// 3/2 of a cell below.
FUNC uint cell_exponent(float lo, float hi) {
    const float LONGEST = 0.003968253968f;          // 1 / 252
    const float STEPS = 6.103515625e-05f;           // 2^-14
    const float ROUNDINGS = 4.76837158203125e-07f;  // 2^-21
    float largest = max(abs(lo), abs(hi));
    PRECISE float size = (hi - lo + largest * STEPS) * LONGEST;
    float least = max(size, largest * ROUNDINGS);
    return clamp((floatBitsToUint(least) >> 23u) + 1u, 1u, 253u);
}
FUNC float cells_per_unit(uint exponent) { return uintBitsToFloat((254u - exponent) << 23u); }

// Returns the largest number that is not above `limit` and whose last 9 bits are an exponent: 2^-14 of it lower at
// most. The first of them is 0, so that a shift leaves nothing but the exponent.
FUNC float origin_below(float limit, uint exponent) {
    uint bits = floatBitsToUint(limit);
    bool is_negative = (bits & 0x80000000u) != 0u;
    uint moved = (bits & 0xfffffe00u) | exponent;
    uint of_negative = moved < bits ? moved + 512u : moved;
    uint of_positive = moved < 512u ? 0x80000000u | exponent : moved - 512u;
    of_positive = moved <= bits ? moved : of_positive;
    return uintBitsToFloat(is_negative ? of_negative : of_positive);
}

FUNC float cell_within(float cells) {
    float from_zero = cells > 0.0f ? cells : 0.0f;
    return from_zero < 255.0f ? from_zero : 255.0f;
}

// Return a plane in cells from the origin, moved outwards by a 256th of a cell at least: a traversal that computes with
// the plane's distance from the ray in float32 is off by less than 2^-10 cells near it, and by its own padding far from
// it.
FUNC uint cell_below(float plane, float origin, float per_unit) {
    PRECISE float cells = (plane - origin) * per_unit - 0.00390625f;
    return uint(cell_within(cells));
}
FUNC uint cell_above(float plane, float origin, float per_unit) {
    PRECISE float cells = (plane - origin) * per_unit + 0.00390625f;
    return uint(ceil(cell_within(cells)));
}

// It is only indexed by constants, so that drivers keep it in registers; a node of `width` children has the first.
struct NodeChildren {
    uint child[8];  // as in BvhNode
    LeafBox box[8];
    uint subtree[8];  // see subtree_info
    uint count;
};

// The destinations of a node's children.
struct NodeOrder {
    uint slots;  // of child i, from bit 4 i on
    uint mask;   // see ChildSlots
    uint axes;   // see axes_by_length
};

// Puts each child in the slot of its number.
FUNC NodeOrder given_order(uint mask, uint axes) {
    NodeOrder order;
    order.slots = 0x76543210u;
    order.mask = mask;
    order.axes = axes;
    return order;
}
FUNC uint slot_of(NodeOrder order, uint child) { return order.slots >> 4u * child & 15u; }

FUNC LeafBox box_around(NodeChildren children, uint width) {
    LeafBox around = empty_box();
    UNROLL for (uint i = 0u; i < width; i = i + 1u) {
        LeafBox wider = around_both(around, children.box[i]);
        around.lo = i < children.count ? wider.lo : around.lo;
        around.hi = i < children.count ? wider.hi : around.hi;
    }
    return around;
}

// Returns the planes of one axis: x, y those below and above the first four slots, z, w those of the others.
FUNC uvec4 encode_axis(NodeChildren children, NodeOrder order, uint axis, float origin, float per_unit, uint width) {
    uvec4 planes = uvec4(0u, 0u, 0u, 0u);
    UNROLL for (uint i = 0u; i < width; i = i + 1u) {
        // A box that nothing hits has lo > hi.
        bool is_solid = is_active(children.box[i]);
        uint below = cell_below(children.box[i].lo[axis], origin, per_unit);
        uint above = cell_above(children.box[i].hi[axis], origin, per_unit);
        uint slot = slot_of(order, i);
        bool is_there = i < children.count && (order.mask >> slot & 1u) != 0u;
        uvec2 both = uvec2(is_solid ? below : 255u, is_solid ? above : 0u) << 8u * (slot & 3u);
        both = is_there ? both : uvec2(0u);
        uvec2 none = uvec2(0u);
        uvec2 first = slot < 4u ? both : none;
        uvec2 second = slot < 4u ? none : both;
        planes = planes | uvec4(first.x, first.y, second.x, second.y);
    }
    return planes;
}

struct NodeRecords {
    CompressedRecord first;
    CompressedRecord second;  // of layout compressed8
};

FUNC NodeRecords encode_node(NodeChildren children, NodeOrder order, uint first_child, uint width) {
    const float FARTHEST = 1.329227995784916e+36f;  // 2^120
    LeafBox around = box_around(children, width);
    around.lo = is_active(around) ? clamp(around.lo, vec3(-FARTHEST), vec3(FARTHEST)) : vec3(0.0f);
    around.hi = around.lo.x <= around.hi.x ? clamp(around.hi, vec3(-FARTHEST), vec3(FARTHEST)) : vec3(0.0f);
    vec3 origin = vec3(0.0f);
    uvec4 planes[3];
    UNROLL for (uint axis = 0u; axis < 3u; axis = axis + 1u) {
        uint exponent = cell_exponent(around.lo[axis], around.hi[axis]);
        PRECISE float lower = around.lo[axis] - cell_size(exponent);
        origin[axis] = origin_below(is_denormal(lower) ? 0.0f : lower, exponent);  // devices may have flushed it
        planes[axis] = encode_axis(children, order, axis, origin[axis], cells_per_unit(exponent), width);
    }
    uint count = uint(bitCount(order.mask & 0xffu));
    NodeRecords node;
    node.first.a = uvec4(floatBitsToUint(origin.x), floatBitsToUint(origin.y), floatBitsToUint(origin.z),
                         first_child | count << 26u | (width == 8u ? WIDE_BIT : 0u));
    node.first.b = uvec4(planes[0].x, planes[0].y, planes[1].x, planes[1].y);
    node.first.c = uvec2(planes[2].x, planes[2].y);
    node.second.a = uvec4(order.mask | order.axes << 16u, 0u, 0u, WIDE_BIT);
    node.second.b = uvec4(planes[0].z, planes[0].w, planes[1].z, planes[1].w);
    node.second.c = uvec2(planes[2].z, planes[2].w);
    return node;
}
FUNC void store_node(REF(CompressedRecord) records, uint index, NodeRecords node, uint width) {
    store_record(records, index, node.first);
    if (width == 8u) store_record(records, index + 1u, node.second);
}

FUNC CompressedRecord encode_primitive(BvhTriangle t) {
    CompressedRecord record;
    record.a =
        uvec4(floatBitsToUint(t.v0.x), floatBitsToUint(t.v0.y), floatBitsToUint(t.v0.z), LEAF_BIT | t.primitive_index);
    record.b =
        uvec4(floatBitsToUint(t.v1.x), floatBitsToUint(t.v1.y), floatBitsToUint(t.v1.z), floatBitsToUint(t.v2.x));
    record.c = uvec2(floatBitsToUint(t.v2.y), floatBitsToUint(t.v2.z));
    return record;
}

FUNC uint corner_of(uvec3 triangle, uint corner) {
    uint number = corner < 3u ? corner : corner - 3u;
    return number == 0u ? triangle.x : (number == 1u ? triangle.y : triangle.z);
}

// Returns the corners across an edge that two triangles share, in either direction.
FUNC uvec2 lone_corners(uvec3 first, uvec3 second) {
    DONT_UNROLL for (uint i = 0u; i < 9u; i = i + 1u) {
        uvec2 corners = uvec2(i % 3u, i / 3u);
        uint begin = corner_of(first, corners.x + 1u);
        uint end = corner_of(first, corners.x + 2u);
        uint a = corner_of(second, corners.y + 1u);
        uint b = corner_of(second, corners.y + 2u);
        if (begin != end && ((a == begin && b == end) || (a == end && b == begin))) return corners;
    }
    return uvec2(0u, 0u);
}

FUNC CompressedRecord encode_pair(BuildTree tree, Leaf leaf, uint which_active) {
    uvec3 first = load_indices(tree.indices, leaf.first);
    uvec3 second = load_indices(tree.indices, leaf.second);
    uvec2 corners = lone_corners(first, second);
    uint begin = corner_of(first, corners.x + 1u);
    uint end = corner_of(first, corners.x + 2u);
    bool is_flipped = corner_of(second, corners.y + 1u) != begin;
    CompressedRecord record;
    record.a = uvec4(leaf.second | which_active << 30u, begin, end, LEAF_BIT | PAIR_BIT | leaf.first);
    record.b = uvec4(corner_of(first, corners.x), corner_of(second, corners.y),
                     corners.x | corners.y << 2u | (is_flipped ? PAIR_FLIPPED : 0u), 0u);
    record.c = uvec2(0u, 0u);
    return record;
}

FUNC CompressedRecord encode_boxed_leaf(BuildTree tree, Leaf leaf, BoxedLeaf boxed) {
    if (has_two(leaf)) return encode_pair(tree, leaf, boxed.which_active);
    return encode_primitive(boxed.last);
}

// Returns the leaf that encode_boxed_leaf made a record from.
FUNC Leaf leaf_of(CompressedRecord record) {
    return make_leaf(index_in(record), is_pair(record) ? second_index_in(record) : index_in(record));
}

FUNC CompressedRecord no_record() {
    CompressedRecord record;
    record.a = uvec4(0u);
    record.b = uvec4(0u);
    record.c = uvec2(0u);
    return record;
}

FUNC CompressedRecord encode_instance(uint index) {
    CompressedRecord record = no_record();
    record.a.w = LEAF_BIT | INSTANCE_BIT | index;
    return record;
}

// Returns three axes, from bit 0 on two bits each, the longest first.
FUNC uint axes_by_length(LeafBox around) {
    vec3 size = is_active(around) ? around.hi - around.lo : vec3(0.0f);
    uint longest = size.x >= size.y ? (size.x >= size.z ? 0u : 2u) : (size.y >= size.z ? 1u : 2u);
    uint second = longest == 0u ? 1u : 0u;
    uint third = longest == 2u ? 1u : 2u;
    bool is_swapped = size[second] < size[third];
    return longest | (is_swapped ? third : second) << 2u | (is_swapped ? second : third) << 4u;
}
FUNC uint axis_at(uint axes, uint level) { return axes >> 2u * level & 3u; }

// Returns the octant of a direction whose negative entries have their bits set: bit 2 of the first axis.
FUNC uint octant_of(uint negative, uint axes) {
    return (negative >> axis_at(axes, 0u) & 1u) << 2u | (negative >> axis_at(axes, 1u) & 1u) << 1u |
           (negative >> axis_at(axes, 2u) & 1u);
}

// Returns a bit for each slot, moved to that of slot ^ octant.
FUNC uint in_order_of_octant(uint slots, uint octant) {
    uint moved = (octant & 1u) != 0u ? (slots & 0x55u) << 1u | (slots >> 1u & 0x55u) : slots;
    moved = (octant & 2u) != 0u ? (moved & 0x33u) << 2u | (moved >> 2u & 0x33u) : moved;
    return (octant & 4u) != 0u ? (moved & 0x0fu) << 4u | (moved >> 4u & 0x0fu) : moved;
}

// Each group of children that share their bits of `slots` so far is split in half along an axis: the bits of the upper
// halves. If their number is odd, the lower half is the larger one.
FUNC uint upper_halves(NodeChildren children, uint slots, uint axis) {
    const float LARGEST_FLOAT = uintBitsToFloat(0x7f7fffffu);
    float center[8];
    UNROLL for (uint i = 0u; i < 8u; i = i + 1u) {
        float middle = center_of(children.box[i])[axis];
        center[i] = abs(middle) <= LARGEST_FLOAT ? middle : 0.0f;  // NaN of a box without an end
    }
    uint upper = 0u;
    UNROLL for (uint i = 0u; i < 8u; i = i + 1u) {
        uint size = 0u;
        uint before = 0u;
        UNROLL for (uint j = 0u; j < 8u; j = j + 1u) {
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
FUNC NodeOrder octant_order(NodeChildren children) {
    NodeOrder order;
    order.axes = axes_by_length(box_around(children, 8u));
    order.slots = 0u;
    UNROLL for (uint level = 0u; level < 3u; level = level + 1u) order.slots =
        order.slots | upper_halves(children, order.slots, axis_at(order.axes, level)) << (2u - level);
    order.mask = 0u;
    UNROLL for (uint i = 0u; i < 8u; i = i + 1u) {
        uint bits = (children.child[i] & LEAF_BIT) == 0u ? 0x101u : 1u;
        order.mask = order.mask | (i < children.count ? bits << slot_of(order, i) : 0u);
    }
    return order;
}
#endif
