// SPDX-License-Identifier: MIT
// Computes the world box of each instance, its record for traversal, and the bounds of the centroids. All later stages
// only read boxes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/place_instance.h"
#include "shaders/swtlas/centroids.glsl"
layout(push_constant, scalar) uniform Push { InstanceLeavesArgs args; };

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    LeafBox centers = empty_box();
    for (uint i = gl_LocalInvocationIndex; i < chunk.count; i += gl_WorkGroupSize.x)
    {
        uint index = chunk.first + i;
        LeafBox box = empty_box();
        InstanceRecord record = in_built_units(AT(args.records, index));
        AT(args.instances, index) = place_instance(record, absent_near(args.records.address), true, box);
        store_box(args.boxes, index, box);
        add_center(centers, box);
    }
    add_centroids(args.centroids, chunk.tree, centers);
}
