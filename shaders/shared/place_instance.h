// SPDX-License-Identifier: MIT
// An instance in the form for traversal, and the world box around it, its leaf in the top level's tree.
//
// Under a rotation the box around a geometry's box may be many times as large as the one around the geometry: for a
// ball, it has 2.2 times the area on average. So it is made from the boxes some levels down the geometry's tree, if
// that can gain anything.
#ifndef TWINRAY_SHARED_PLACE_INSTANCE_H
#define TWINRAY_SHARED_PLACE_INSTANCE_H
#include "shaders/shared/node_boxes.h"

// The number of levels of boxes below the root that are used, by how many children a node has.
const uint BINARY_CUT_LEVELS = 8u;
const uint CUT_LEVELS = 4u;
const uint WIDE_CUT_LEVELS = 3u;
const uint CUT_STACK = 7u * (WIDE_CUT_LEVELS - 1u) + 1u;  // nodes that wait: fewer where nodes have fewer children

FUNC uint cut_levels(SwGeometry geometry) {
    if (is_absent(geometry.records)) return BINARY_CUT_LEVELS;
    return is_wide_node(load_record(geometry.records, geometry.bvh.root)) ? WIDE_CUT_LEVELS : CUT_LEVELS;
}

// Returns a box around `box` under the map, but for rounding.
FUNC LeafBox box_under(Rows map, LeafBox box) {
    LeafBox under;
    for (uint axis = 0u; axis < 3u; axis = axis + 1u) {
        vec4 row = axis == 0u ? map.r0 : (axis == 1u ? map.r1 : map.r2);
        vec3 a = vec3(row.x * box.lo.x, row.y * box.lo.y, row.z * box.lo.z);
        vec3 b = vec3(row.x * box.hi.x, row.y * box.hi.y, row.z * box.hi.z);
        under.lo[axis] = row.w + (min(a.x, b.x) + min(a.y, b.y) + min(a.z, b.z));
        under.hi[axis] = row.w + (max(a.x, b.x) + max(a.y, b.y) + max(a.z, b.z));
    }
    return under;
}

// Bounds the rounding errors of box_under and of rays, when these are taken to object space and back, along one axis:
// both are a few 2^-24 of the magnitudes involved, and this is 2^-20 of them. `low`, `high`: from box_under.
FUNC float rounding_of_instance(vec4 row, LeafBox box, Rows to_object, float low, float high) {
    float reach = max(abs(row.w), max(abs(low), abs(high)));
    vec3 size = abs(vec3(row.x, row.y, row.z));
    reach = max(reach, dot(size, max(abs(box.lo), abs(box.hi))));
    reach = max(reach, dot(size, vec3(abs(to_object.r0.w), abs(to_object.r1.w), abs(to_object.r2.w))));
    return reach * 9.5367431640625e-07f;
}

FUNC bool is_along_an_axis(vec4 row) { return uint(row.x != 0.0f) + uint(row.y != 0.0f) + uint(row.z != 0.0f) < 2u; }
// Returns whether the box around a geometry's box is then that around the geometry.
FUNC bool keeps_axes(Rows map) {
    return is_along_an_axis(map.r0) && is_along_an_axis(map.r1) && is_along_an_axis(map.r2);
}

FUNC bool is_within(LeafBox box, LeafBox outer) {
    return box.lo.x >= outer.lo.x && box.lo.y >= outer.lo.y && box.lo.z >= outer.lo.z && box.hi.x <= outer.hi.x &&
           box.hi.y <= outer.hi.y && box.hi.z <= outer.hi.z;
}

// Returns a box around the geometry under the map, but for rounding: around its boxes CUT_LEVELS below the root, and
// the leaves above.
FUNC LeafBox box_of_cut(SwGeometry geometry, Rows to_world) {
    uint lowest = cut_levels(geometry);
    LeafBox around = empty_box();
    uint stack[CUT_STACK];
    uint levels[CUT_STACK];
    uint height = 1u;
    stack[0] = geometry.bvh.root;
    levels[0] = 0u;
    while (height > 0u) {
        height = height - 1u;
        uint level = levels[height] + 1u;
        AnyNode node = node_of(geometry, stack[height]);
        for (uint slot = 0u; slot < slots_of(geometry); slot = slot + 1u) {
            if (!has_child(node.slots, slot) || !is_active(box_in(geometry, node, slot))) continue;
            LeafBox box = box_under(to_world, box_in(geometry, node, slot));
            if (is_within(box, around)) continue;
            uint child = child_in(geometry, node, slot);
            if (level < lowest && is_inner_child(geometry, child)) {
                stack[height] = child;
                levels[height] = level;
                height = height + 1u;
                continue;
            }
            around.lo = min(around.lo, box.lo);
            around.hi = max(around.hi, box.hi);
        }
    }
    return around;
}

// Returns a box around the geometry under the map, widened by rounding; tight if `is_tight`, empty if the geometry's
// is.
//
// It and place_instance() return at one place: they are inlined, and a kernel has no code that its constants rule out.
FUNC LeafBox box_of_instance(SwGeometry geometry, Rows to_world, Rows to_object, bool is_tight) {
    LeafBox box, around = empty_box();
    box.lo = geometry.bvh.lo;
    box.hi = geometry.bvh.hi;
    if (is_active(box)) {
        LeafBox world = box_under(to_world, box);
        vec3 rounding = vec3(rounding_of_instance(to_world.r0, box, to_object, world.lo.x, world.hi.x),
                             rounding_of_instance(to_world.r1, box, to_object, world.lo.y, world.hi.y),
                             rounding_of_instance(to_world.r2, box, to_object, world.lo.z, world.hi.z));
        // Otherwise products may be infinite, and their sums NaN.
        bool is_in_range = largest_entry(rounding) < uintBitsToFloat(0x7f800000u);
        if (is_tight && is_in_range && !keeps_axes(to_world) && is_inner_child(geometry, geometry.bvh.root)) {
            // Planes of records are farther out than the box.
            LeafBox cut = box_of_cut(geometry, to_world);
            world.lo = max(world.lo, cut.lo);
            world.hi = min(world.hi, cut.hi);
        }
        around.lo = world.lo - rounding;
        around.hi = world.hi + rounding;
    }
    return around;
}

// `record`: in built units. `absent`: the address of a tree that does not exist. `box`: in world space, empty if
// nothing of the instance can be hit, and tight if `is_tight`: a top level of one instance gains nothing by that.
FUNC SwInstance place_instance(InstanceRecord record, Address absent, bool is_tight, INOUT(LeafBox) box) {
    Rows to_world = to_world_of(record);
    Rows to_object = inverse_of(to_world);
    SwInstance instance;
    instance.world_to_object = to_object;
    instance.custom_index_mask = record.custom_index_mask;
    instance.flags = flags_of(record);
    instance.nodes = REF(BvhNode)(absent);
    instance.triangles = REF(BvhTriangle)(absent);
    instance.records = REF(CompressedRecord)(absent);
    instance.vertices = Floats(absent);
    instance.kind = GEOMETRY_TRIANGLES;
    instance.root = NOTHING;
    instance.extent = 0.0f;
    instance.reserved = 0u;
    box = empty_box();
    if (has_geometry(record) && is_usable(to_world, to_object)) {
        SwGeometry geometry = AT(REF(SwGeometry)(record.geometry), 0);
        instance.nodes = geometry.bvh.nodes;
        instance.triangles = geometry.triangles;
        instance.records = geometry.records;
        instance.vertices = geometry.vertices;
        instance.root = geometry.bvh.root;
        instance.kind = geometry.kind;
        instance.extent = largest_coordinate(geometry.bvh.lo, geometry.bvh.hi);
        box = box_of_instance(geometry, to_world, to_object, is_tight);
    }
    return instance;
}
#endif
