// SPDX-License-Identifier: MIT
// The world box of each instance, what traversal needs of it, and the bounds of the centroids. The only stage that
// knows instances from triangles: all later ones see boxes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/swtlas/centroids.glsl"
layout(push_constant, scalar) uniform Push { InstanceLeavesArgs args; };

LeafBox place_instance(uint index)
{
    InstanceRecord record = in_built_units(AT(args.records, index));
    Rows to_world = to_world_of(record);
    Rows to_object = inverse_of(to_world);
    SwInstance instance;
    instance.world_to_object[0] = to_object.r0;
    instance.world_to_object[1] = to_object.r1;
    instance.world_to_object[2] = to_object.r2;
    instance.custom_index_mask = record.custom_index_mask;
    instance.flags = flags_of(record);
    instance.kind = GEOMETRY_TRIANGLES;
    instance.root = NOTHING;
    instance.extent = 0.0f;
    instance.reserved = 0u;
    LeafBox box = empty_box();
    if (record.geometry != 0ul && is_usable(to_world, to_object))
    {
        SwGeometry geometry = AT(REF(SwGeometry)(record.geometry), 0);
        instance.nodes = geometry.bvh.nodes;
        instance.triangles = geometry.triangles;
        instance.records = geometry.records;
        instance.record_boxes = geometry.record_boxes;
        instance.root = geometry.bvh.root;
        instance.kind = geometry.kind;
        instance.extent = largest_coordinate(geometry.bvh.lo, geometry.bvh.hi);
        box = box_of_instance(record, geometry.bvh.lo, geometry.bvh.hi, to_object);
    }
    AT(args.instances, index) = instance;
    return box;
}

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    LeafBox centers = empty_box();
    for (uint i = gl_LocalInvocationIndex; i < block.count; i += gl_WorkGroupSize.x)
    {
        LeafBox box = place_instance(block.first + i);
        AT(args.boxes, block.first + i) = box;
        add_center(centers, box);
    }
    add_centroids(args.centroids, block.tree, centers);
}
