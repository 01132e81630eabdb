// SPDX-License-Identifier: MIT
// Layouts compressed4 and compressed8: one array of records, each of which is a node, a primitive or an instance. The
// children of a node are side by side, so that one number leads to all of them. A node has up to four children; in
// layout compressed8 it is two records, and has up to eight.
//
// A node keeps its children's boxes as planes of a grid, 8 bits each, rounded outwards by more than a traversal's
// arithmetic may lose (after Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs", 2017, whose nodes have eight children in 80 bytes, too).
#ifndef TWINRAY_SHARED_COMPRESSED_H
#define TWINRAY_SHARED_COMPRESSED_H
#include "shaders/shared/build.h"
#include "shaders/shared/surface_area.h"

const uint MOST_RECORDS = 1u << 26u;  // the limit of a tree: an entry on the stack can name so many; 40 million leaves

// Returns the number of records of a node, by the most children that it may have.
FUNC uint records_of_node(uint width) { return width == 8u ? 2u : 1u; }

// Records that a tree of so many leaves needs at most; those that it does not use are `none`.
//  - Four children a node: one with fewer has leaves only, so that the most nodes come from pairs of leaves, of which
//    3 n + 1 have n nodes above them.
//  - Eight: one with fewer has leaves only, four at least, but for up to two others below each that has eight (see
//    open_next of collapse.h), and the root: at most one node for three leaves.
FUNC uint record_count(uint leaf_count, uint width) {
    if (width == 8u) return leaf_count < 3u ? 2u * leaf_count : max((5u * leaf_count - 2u) / 3u, leaf_count + 2u);
    return leaf_count == 0u ? 0u : (5u * leaf_count - 1u) / 3u;
}
FUNC uint records_below(uint leaf_count, uint width) {
    return leaf_count < 2u ? 0u : record_count(leaf_count, width) - records_of_node(width);
}
FUNC uint children_in(CompressedRecord node) { return node.a.w >> 26u & 15u; }  // 0: none
FUNC uint first_child_of(CompressedRecord node) { return node.a.w & (MOST_RECORDS - 1u); }
FUNC bool is_none(CompressedRecord record) { return record.a.w == 0u; }
FUNC bool is_leaf(CompressedRecord record) { return (record.a.w & LEAF_BIT) != 0u; }
FUNC bool is_wide_node(CompressedRecord record) {
    return (record.a.w & (LEAF_BIT | WIDE_BIT)) == WIDE_BIT && children_in(record) != 0u;
}
FUNC bool is_instance(CompressedRecord leaf) { return (leaf.a.w & INSTANCE_BIT) != 0u; }
FUNC bool is_pair(CompressedRecord leaf) { return (leaf.a.w & PAIR_BIT) != 0u; }
// of the primitive, of the first of two triangles, or of the instance
FUNC uint index_in(CompressedRecord leaf) { return leaf.a.w & ~(LEAF_BIT | INSTANCE_BIT | PAIR_BIT); }

const uint FIRST_ACTIVE = 0x40000000u;
const uint SECOND_ACTIVE = 0x80000000u;
FUNC uint second_index_in(CompressedRecord pair) { return pair.a.x & ~(FIRST_ACTIVE | SECOND_ACTIVE); }

#ifdef TWINRAY_WIDE_LOADS  // of modules of their own, see KernelTuning::has_wide_loads
REFERENCE(RecordWords, , uint64_t items[], 8)
FUNC CompressedRecord load_record(REF(CompressedRecord) records, uint index) {
    RecordWords words = RecordWords(address_at(records.address, index, 40u));
    CompressedRecord record;
    record.a = uvec4(unpackUint2x32(AT(words, 0)), unpackUint2x32(AT(words, 1)));
    record.b = uvec4(unpackUint2x32(AT(words, 2)), unpackUint2x32(AT(words, 3)));
    record.c = unpackUint2x32(AT(words, 4));
    return record;
}
#else
FUNC CompressedRecord load_record(REF(CompressedRecord) records, uint index) { return AT(records, index); }
#endif
FUNC void store_record(REF(CompressedRecord) records, uint index, CompressedRecord record) {
    AT(records, index) = record;
}

// Writes a record that no node leads to; its other words stay.
FUNC void store_no_record(REF(CompressedRecord) records, uint index) { AT(records, index).a.w = 0u; }

// The places of a node's children: one after the other, by slot.
struct ChildSlots {
    uint first;
    uint mask;  // bit i: there is a child in slot i; bit 8 + i: it is a node of two records
};

FUNC ChildSlots child_slots(CompressedRecord node, CompressedRecord second_half) {
    ChildSlots slots;
    slots.first = first_child_of(node);
    slots.mask = is_wide_node(node) ? second_half.a.x & 0xffffu : (1u << children_in(node)) - 1u;
    return slots;
}
FUNC bool has_child(ChildSlots slots, uint slot) { return (slots.mask >> slot & 1u) != 0u; }
FUNC uint child_index(ChildSlots slots, uint slot) {
    uint before = (1u << slot) - 1u;
    return slots.first + uint(bitCount(slots.mask & (before | before << 8u)));
}
FUNC uint children_end(ChildSlots slots) { return slots.first + uint(bitCount(slots.mask)); }

// Returns the second half of a node of layout compressed8; of others any record.
FUNC CompressedRecord second_half_of(REF(CompressedRecord) records, uint index, CompressedRecord node) {
    return load_record(records, is_wide_node(node) ? index + 1u : index);
}

// Returns the slot of a node that the record `target` is in or below. Records below different children do not mix, so
// that it is the child whose own children begin last of those that begin no later.
FUNC uint slot_towards(REF(CompressedRecord) records, ChildSlots slots, uint target) {
    uint found = 0u;
    uint latest = 0u;
    DONT_UNROLL for (uint slot = 0u; slot < 8u; slot = slot + 1u) {
        uint index = child_index(slots, slot);
        uint child = has_child(slots, slot) ? AT(records, index).a.w : LEAF_BIT;
        uint begin = child & (MOST_RECORDS - 1u);
        bool is_it = has_child(slots, slot) && index == target;  // found: none is later
        begin = is_it ? NOTHING : begin;
        bool is_later = is_it || ((child & LEAF_BIT) == 0u && begin <= target && begin >= latest);
        found = is_later ? slot : found;
        latest = is_later ? begin : latest;
    }
    return found;
}

FUNC float cell_size(uint exponent) { return uintBitsToFloat(exponent << 23u); }
FUNC vec3 grid_origin(CompressedRecord node) {
    return vec3(uintBitsToFloat(node.a.x), uintBitsToFloat(node.a.y), uintBitsToFloat(node.a.z));
}
FUNC vec3 grid_cell(CompressedRecord node) {
    return vec3(cell_size(node.a.x), cell_size(node.a.y), cell_size(node.a.z));
}

// Returns the box of a node's child as rays meet it.
FUNC LeafBox box_in_planes(CompressedRecord node, CompressedRecord second_half, uint slot) {
    bool is_second = slot > 3u;
    uvec4 b = is_second ? second_half.b : node.b;
    uvec2 c = is_second ? second_half.c : node.c;
    uint shift = 8u * (slot & 3u);
    uvec3 below = uvec3(b.x, b.z, c.x) >> shift & 0xffu;
    uvec3 above = uvec3(b.y, b.w, c.y) >> shift & 0xffu;
    if (below.x > above.x) return empty_box();
    LeafBox box;
    box.lo = grid_origin(node) + grid_cell(node) * vec3(below);
    box.hi = grid_origin(node) + grid_cell(node) * vec3(above);
    return box;
}

// Returns half the areas of the boxes of a node's children, as rays meet them; 0 of other records.
FUNC float areas_in(REF(CompressedRecord) records, uint index, float unit) {
    CompressedRecord node = load_record(records, index);
    if (is_leaf(node) || children_in(node) == 0u) return 0.0f;
    CompressedRecord second_half = second_half_of(records, index, node);
    ChildSlots slots = child_slots(node, second_half);
    float sum = 0.0f;
    DONT_UNROLL for (uint slot = 0u; slot < 8u; slot = slot + 1u) {
        if (!has_child(slots, slot)) continue;
        LeafBox box = box_in_planes(node, second_half, slot);
        sum = sum + half_area(box.lo, box.hi, unit);
    }
    return sum;
}

// Returns the primitive of a leaf of one.
FUNC BvhTriangle primitive_of(CompressedRecord record) {
    BvhTriangle t;
    t.v0 = vec3(uintBitsToFloat(record.a.x), uintBitsToFloat(record.a.y), uintBitsToFloat(record.a.z));
    t.v1 = vec3(uintBitsToFloat(record.b.x), uintBitsToFloat(record.b.y), uintBitsToFloat(record.b.z));
    t.v2 = vec3(uintBitsToFloat(record.b.w), uintBitsToFloat(record.c.x), uintBitsToFloat(record.c.y));
    t.primitive_index = index_in(record);
    return t;
}

// LeafVertices::corners has the corner of each triangle that the other one lacks, 2 bits of the first and 2 of the
// second, and says whether the second has their edge in the other direction, counted from that corner on.
const uint PAIR_FLIPPED = 16u;

// The vertices of a leaf's primitives. For a box, `first` is its lowest corner and `begin` its highest.
struct LeafVertices {
    vec3 begin;  // of the edge that two triangles share
    vec3 end;
    vec3 first;  // the third of the first triangle
    vec3 second;
    uint corners;
    uint there;        // bit i: primitive i can be hit
    uvec2 primitives;  // their indices
};

FUNC LeafVertices vertices_of(BvhTriangle t) {
    LeafVertices of_leaf;
    of_leaf.first = t.v0;
    of_leaf.begin = t.v1;
    of_leaf.end = t.v2;
    of_leaf.second = t.v0;
    of_leaf.corners = 0u;
    of_leaf.there = 1u;
    of_leaf.primitives = uvec2(t.primitive_index, t.primitive_index);
    return of_leaf;
}

FUNC LeafVertices vertices_of_leaf(CompressedRecord record, Floats vertices) {
    if (!is_pair(record)) return vertices_of(primitive_of(record));
    LeafVertices of_leaf;
    of_leaf.begin = load_position(vertices, record.a.y);
    of_leaf.end = load_position(vertices, record.a.z);
    of_leaf.first = load_position(vertices, record.b.x);
    of_leaf.second = load_position(vertices, record.b.y);
    of_leaf.corners = record.b.z;
    of_leaf.there = record.a.x >> 30u;
    of_leaf.primitives = uvec2(index_in(record), second_index_in(record));
    return of_leaf;
}

// The corners of one of the primitives in their order, of four numbers each.
struct OrderedCorners {
    vec4 a;
    vec4 b;
    vec4 c;
};

FUNC OrderedCorners ordered_corners(uint corners, bool is_second, vec4 third, vec4 begin, vec4 end) {
    uint lone = is_second ? corners >> 2u & 3u : corners & 3u;
    bool is_flipped = is_second && (corners & PAIR_FLIPPED) != 0u;
    vec4 next = is_flipped ? end : begin;
    vec4 last = is_flipped ? begin : end;
    OrderedCorners ordered;
    ordered.a = lone == 0u ? third : (lone == 1u ? last : next);
    ordered.b = lone == 1u ? third : (lone == 2u ? last : next);
    ordered.c = lone == 2u ? third : (lone == 0u ? last : next);
    return ordered;
}

FUNC BvhTriangle primitive_in(LeafVertices vertices, bool is_second) {
    OrderedCorners corners =
        ordered_corners(vertices.corners, is_second, vec4(is_second ? vertices.second : vertices.first, 0.0f),
                        vec4(vertices.begin, 0.0f), vec4(vertices.end, 0.0f));
    BvhTriangle t;
    t.v0 = vec3(corners.a.x, corners.a.y, corners.a.z);
    t.v1 = vec3(corners.b.x, corners.b.y, corners.b.z);
    t.v2 = vec3(corners.c.x, corners.c.y, corners.c.z);
    t.primitive_index = is_second ? vertices.primitives.y : vertices.primitives.x;
    return t;
}
#endif
