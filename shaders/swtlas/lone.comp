// SPDX-License-Identifier: MIT
// Builds, and refits, trees of one leaf each, which need neither an order nor a hierarchy.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/collapse.h"
#include "shaders/shared/place_instance.h"
layout(constant_id = NODE_WIDTH_CONSTANT) const uint NODE_WIDTH = 4u;

// Stores all of it except the leaf, which is record 0 if there are records.
void store_lone_tree(REF(Bvh) bvh, REF(CompressedRecord) records, LeafBox box) {
    AT(bvh, 0).root = is_absent(records) ? LEAF_BIT : 0u;
    AT(bvh, 0).leaf_count = 1u;
    AT(bvh, 0).lo = box.lo;
    AT(bvh, 0).hi = box.hi;
    if (NODE_WIDTH == 8u && !is_absent(records)) store_no_record(records, 1u);
}

#ifdef KERNEL_LONE_LEAVES
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main() {
    uint index = global_index();
    if (index >= args.leaf_count) return;
    BuildTree tree = AT(args.trees, index);
    Leaf leaf = leaf_at(tree, 0u);
    BoxedLeaf boxed = boxed_leaf(tree, leaf);
    store_lone_tree(tree.bvh, tree.records, boxed.box);
    if (is_absent(tree.records))
        AT(tree.triangles, 0) = boxed.last;
    else
        store_record(tree.records, 0u, encode_boxed_leaf(tree, leaf, boxed));
}
#endif

#ifdef KERNEL_LONE_INSTANCE
layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { LoneInstanceArgs args; };

void main() {
    if (global_index() != 0u) return;
    LeafBox box = empty_box();
    InstanceRecord record = in_built_units(AT(args.records, 0));
    AT(args.instances, 0) = place_instance(record, absent_near(args.records.address), false, box);
    store_lone_tree(args.bvh, args.leaves, box);
    if (!is_absent(args.leaves)) store_record(args.leaves, 0u, encode_instance(0u));
}
#endif
