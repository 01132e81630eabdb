// SPDX-License-Identifier: MIT
// Computes the box of each leaf, and adds the centres of a chunk's leaves to their tree's CentroidBounds: each
// invocation those of its own leaves, then a tree in workgroup memory, then six atomics. All later stages only read
// boxes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/place_instance.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
#include "shaders/engine/group_box.glsl"

void add_center(inout LeafBox centers, LeafBox box) {
    if (!is_active(box)) return;
    vec3 center = center_of(box);
    centers.lo = min(centers.lo, center);
    centers.hi = max(centers.hi, center);
}

// Called by all invocations of the group.
void add_centroids(REF(CentroidBounds) centroids, uint tree, LeafBox centers) {
    uint thread = gl_LocalInvocationID.x;
    join_boxes(centers.lo, centers.hi);
    if (thread >= 3u || !(group_lo[0][thread] <= group_hi[0][thread])) return;
    atomicMin(AT(centroids, tree).lo[thread], ordered_bits(group_lo[0][thread]));
    atomicMax(AT(centroids, tree).hi[thread], ordered_bits(group_hi[0][thread]));
}

#ifdef KERNEL_LEAVES_TRIANGLES
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main() {
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    BuildTree tree = AT(args.trees, chunk.tree);
    LeafBox centers = empty_box();
    for (uint i = gl_LocalInvocationID.x; i < chunk.count; i += gl_WorkGroupSize.x) {
        LeafBox box = boxed_leaf(tree, leaf_at(tree, chunk.first + i - tree.first)).box;
        store_box(args.boxes, chunk.first + i, box);
        add_center(centers, box);
    }
    add_centroids(args.centroids, chunk.tree, centers);
}
#endif

#ifdef KERNEL_LEAVES_INSTANCES
// Also writes the record of each instance for traversal.
layout(push_constant, scalar) uniform Push { InstanceLeavesArgs args; };

void main() {
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    LeafBox centers = empty_box();
    for (uint i = gl_LocalInvocationIndex; i < chunk.count; i += gl_WorkGroupSize.x) {
        uint index = chunk.first + i;
        LeafBox box = empty_box();
        InstanceRecord record = in_built_units(AT(args.records, index));
        AT(args.instances, index) = place_instance(record, absent_near(args.records.address), true, box);
        store_box(args.boxes, index, box);
        add_center(centers, box);
    }
    add_centroids(args.centroids, chunk.tree, centers);
}
#endif
