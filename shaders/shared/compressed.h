// SPDX-License-Identifier: MIT
// Layout compressed4: one array of records, of which each is a node of up to four children, a primitive or an instance.
// The children of a node lie side by side, so that one number leads to all of them, and a traversal fetches one record
// an iteration, whatever it is.
//
// A node keeps its children's boxes as planes of a grid, 8 bits each, rounded outwards by more than a traversal's
// arithmetic may lose (after Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs", 2017, who have eight children and bit masks).
#ifndef TWINRAY_SHARED_COMPRESSED_H
#define TWINRAY_SHARED_COMPRESSED_H
#include "shaders/shared/build.h"
#include "shaders/shared/surface_area.h"
#include "shaders/shared/whole.h"

const uint MOST_RECORDS = 1u << 26u; // a tree may have: what an entry on the stack can name; 40 million leaves

// Records that a tree of so many leaves needs at most: a node with fewer than four children has leaves only, so that
// the most nodes come from pairs of leaves, of which 3 n + 1 have n nodes above them. Those that a tree does not use
// are `none`.
FUNC uint record_count(uint leaf_count) { return leaf_count == 0u ? 0u : (5u * leaf_count - 1u) / 3u; }
FUNC uint records_below(uint leaf_count) { return leaf_count < 2u ? 0u : record_count(leaf_count) - 1u; }
FUNC uint children_in(CompressedRecord node) { return node.a.w >> 26u; } // 0: none
FUNC uint first_child_of(CompressedRecord node) { return node.a.w & (MOST_RECORDS - 1u); }
FUNC bool is_none(CompressedRecord record) { return record.a.w == 0u; }
FUNC bool is_leaf(CompressedRecord record) { return (record.a.w & LEAF_BIT) != 0u; }
FUNC bool is_instance(CompressedRecord leaf) { return (leaf.a.w & INSTANCE_BIT) != 0u; }
FUNC uint index_in(CompressedRecord leaf) { return leaf.a.w & ~(LEAF_BIT | INSTANCE_BIT); } // of the primitive or instance

FUNC CompressedRecord load_record(REF(CompressedRecord) records, uint index) { return AT(records, index); }
FUNC void store_record(REF(CompressedRecord) records, uint index, CompressedRecord record)
{
    AT(records, index) = record;
}

// Where no node leads to; the other words are as they were.
FUNC void store_no_record(REF(CompressedRecord) records, uint index)
{
    AT(records, index).a.w = 0u;
}

// Which child of a node the record `target` is or lies below. The records below a child lie side by side, in the order
// of the children, so that it is the last one whose own children begin no later.
FUNC uint child_towards(REF(CompressedRecord) records, CompressedRecord node, uint target)
{
    uint first = first_child_of(node);
    uint count = children_in(node);
    uint found = target - first;
    if (found < count) return found;
    for (uint i = 0u; i < count; i = i + 1u)
    {
        uint child = AT(records, first + i).a.w;
        bool begins_before = (child & LEAF_BIT) == 0u && (child & (MOST_RECORDS - 1u)) <= target;
        found = begins_before ? i : found;
    }
    return found;
}

// The exponent of the smallest power of two by which lo..hi is 252 cells long at most, with what origin_below may lie
// farther off, and a cell some roundings of the coordinates: then what lies a cell below lo, rounded, is 1/2 to 3/2 of
// a cell below.
FUNC uint cell_exponent(float lo, float hi)
{
    const float LONGEST = 0.003968253968f;              // 1 / 252
    const float STEPS = 6.103515625e-05f;               // 2^-14
    const float ROUNDINGS = 4.76837158203125e-07f;      // 2^-21
    float largest = max(abs(lo), abs(hi));
    PRECISE float size = (hi - lo + largest * STEPS) * LONGEST;
    float least = max(size, largest * ROUNDINGS);
    return clamp((floatBitsToUint(least) >> 23u) + 1u, 1u, 253u);
}
FUNC float cell_size(uint exponent) { return uintBitsToFloat(exponent << 23u); }
FUNC float cells_per_unit(uint exponent) { return uintBitsToFloat((254u - exponent) << 23u); }

// The largest number that is not above `limit` and whose last 9 bits are an exponent: 2^-14 of it lower at most. The
// first of them is 0, so that a shift leaves nothing but the exponent.
FUNC float origin_below(float limit, uint exponent)
{
    uint bits = floatBitsToUint(limit);
    bool is_negative = (bits & 0x80000000u) != 0u;
    uint moved = (bits & 0xfffffe00u) | exponent;
    uint of_negative = moved < bits ? moved + 512u : moved;
    uint of_positive = moved < 512u ? 0x80000000u | exponent : moved - 512u;
    of_positive = moved <= bits ? moved : of_positive;
    return uintBitsToFloat(is_negative ? of_negative : of_positive);
}

FUNC float cell_within(float cells)
{
    float from_zero = cells > 0.0f ? cells : 0.0f;
    return from_zero < 255.0f ? from_zero : 255.0f;
}

// A plane in cells from the origin, moved outwards by a 256th of a cell at least: a traversal that computes with a
// plane's distance from the ray in float32 is off by less than 2^-10 cells near it, and by its own padding far from it.
FUNC uint cell_below(float plane, float origin, float per_unit)
{
    PRECISE float cells = (plane - origin) * per_unit - 0.00390625f;
    return whole_number(floor(cell_within(cells)));
}
FUNC uint cell_above(float plane, float origin, float per_unit)
{
    PRECISE float cells = (plane - origin) * per_unit + 0.00390625f;
    return whole_number(ceil(cell_within(cells)));
}

// Only ever indexed by constants, so that drivers keep it in registers.
struct NodeChildren
{
    uint child[4]; // as in BvhNode
    LeafBox box[4];
    uint below[4]; // see make_below
    uint count;
};

FUNC LeafBox box_around(NodeChildren children)
{
    LeafBox around = empty_box();
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        LeafBox wider = around_both(around, children.box[i]);
        around.lo = i < children.count ? wider.lo : around.lo;
        around.hi = i < children.count ? wider.hi : around.hi;
    }
    return around;
}

// The planes of one axis: x those below, y those above.
FUNC uvec2 encode_axis(NodeChildren children, uint axis, float origin, float per_unit)
{
    uvec2 planes = uvec2(0u, 0u);
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        // A box that nothing hits has lo > hi.
        bool is_solid = is_active(children.box[i]);
        uint below = cell_below(children.box[i].lo[axis], origin, per_unit);
        uint above = cell_above(children.box[i].hi[axis], origin, per_unit);
        uvec2 more = uvec2(is_solid ? below : 255u, is_solid ? above : 0u) << 8u * i;
        planes = planes | (i < children.count ? more : uvec2(0u));
    }
    return planes;
}

FUNC CompressedRecord encode_node(NodeChildren children, uint first_child)
{
    const float FARTHEST = 1.329227995784916e+36f; // 2^120
    LeafBox around = box_around(children);
    around.lo = is_active(around) ? clamp(around.lo, vec3(-FARTHEST), vec3(FARTHEST)) : vec3(0.0f);
    around.hi = around.lo.x <= around.hi.x ? clamp(around.hi, vec3(-FARTHEST), vec3(FARTHEST)) : vec3(0.0f);
    vec3 origin = vec3(0.0f);
    uvec2 planes[3];
    UNROLL for (uint axis = 0u; axis < 3u; axis = axis + 1u)
    {
        uint exponent = cell_exponent(around.lo[axis], around.hi[axis]);
        PRECISE float lower = around.lo[axis] - cell_size(exponent);
        origin[axis] = origin_below(lower, exponent);
        planes[axis] = encode_axis(children, axis, origin[axis], cells_per_unit(exponent));
    }
    CompressedRecord record;
    record.a = uvec4(floatBitsToUint(origin.x), floatBitsToUint(origin.y), floatBitsToUint(origin.z),
                     first_child | children.count << 26u);
    record.b = uvec4(planes[0].x, planes[0].y, planes[1].x, planes[1].y);
    record.c = planes[2];
    return record;
}

FUNC CompressedRecord encode_primitive(BvhTriangle t)
{
    CompressedRecord record;
    record.a = uvec4(floatBitsToUint(t.v0.x), floatBitsToUint(t.v0.y), floatBitsToUint(t.v0.z), LEAF_BIT | t.primitive_index);
    record.b = uvec4(floatBitsToUint(t.v1.x), floatBitsToUint(t.v1.y), floatBitsToUint(t.v1.z), floatBitsToUint(t.v2.x));
    record.c = uvec2(floatBitsToUint(t.v2.y), floatBitsToUint(t.v2.z));
    return record;
}

FUNC CompressedRecord no_record()
{
    CompressedRecord record;
    record.a = uvec4(0u);
    record.b = uvec4(0u);
    record.c = uvec2(0u);
    return record;
}

FUNC CompressedRecord encode_instance(uint index)
{
    CompressedRecord record = no_record();
    record.a.w = LEAF_BIT | INSTANCE_BIT | index;
    return record;
}

FUNC vec3 grid_origin(CompressedRecord node)
{
    return vec3(uintBitsToFloat(node.a.x), uintBitsToFloat(node.a.y), uintBitsToFloat(node.a.z));
}
FUNC vec3 grid_cell(CompressedRecord node)
{
    return vec3(cell_size(node.a.x), cell_size(node.a.y), cell_size(node.a.z));
}

// The box of a node's child as rays meet it.
FUNC LeafBox box_in_planes(CompressedRecord node, uint child)
{
    uvec3 below = uvec3(node.b.x, node.b.z, node.c.x) >> 8u * child & 0xffu;
    uvec3 above = uvec3(node.b.y, node.b.w, node.c.y) >> 8u * child & 0xffu;
    if (below.x > above.x) return empty_box();
    LeafBox box;
    box.lo = grid_origin(node) + grid_cell(node) * vec3(below);
    box.hi = grid_origin(node) + grid_cell(node) * vec3(above);
    return box;
}

// Half the areas of the boxes of a node's children, as rays meet them; 0 of other records.
FUNC float areas_in(CompressedRecord node, float unit)
{
    if (is_leaf(node)) return 0.0f;
    float sum = 0.0f;
    UNROLL for (uint i = 0u; i < 4u; i = i + 1u)
    {
        LeafBox box = box_in_planes(node, i);
        if (i < children_in(node)) sum = sum + half_area(box.lo, box.hi, unit);
    }
    return sum;
}

// The same in layout bvh4.
FUNC float areas_of_boxes(CompressedRecord node, REF(LeafBox) boxes, float unit)
{
    if (is_leaf(node)) return 0.0f;
    float sum = 0.0f;
    for (uint i = 0u; i < children_in(node); i = i + 1u)
    {
        LeafBox box = load_box(boxes, first_child_of(node) + i);
        sum = sum + half_area(box.lo, box.hi, unit);
    }
    return sum;
}

FUNC BvhTriangle primitive_of(CompressedRecord record)
{
    BvhTriangle t;
    t.v0 = vec3(uintBitsToFloat(record.a.x), uintBitsToFloat(record.a.y), uintBitsToFloat(record.a.z));
    t.v1 = vec3(uintBitsToFloat(record.b.x), uintBitsToFloat(record.b.y), uintBitsToFloat(record.b.z));
    t.v2 = vec3(uintBitsToFloat(record.b.w), uintBitsToFloat(record.c.x), uintBitsToFloat(record.c.y));
    t.primitive_index = index_in(record);
    return t;
}
#endif
