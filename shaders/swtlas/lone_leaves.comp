// SPDX-License-Identifier: MIT
// Finishes trees of one leaf each, which need neither an order nor a hierarchy.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/collapse.h"
layout(local_size_x = 64) in;
layout(constant_id = NODE_WIDTH_CONSTANT) const uint NODE_WIDTH = 4u;
layout(push_constant, scalar) uniform Push { BuildArgs args; };

void main()
{
    uint index = global_index();
    if (index >= args.leaf_count) return;
    BuildTree tree = AT(args.trees, index);
    LeafBox box = load_box(args.boxes, tree.first);
    bool is_binary = is_absent(tree.records);
    AT(tree.bvh, 0).root = is_binary ? LEAF_BIT : 0u;
    AT(tree.bvh, 0).leaf_count = 1u;
    AT(tree.bvh, 0).lo = box.lo;
    AT(tree.bvh, 0).hi = box.hi;
    if (!is_binary)
    {
        store_record(tree.records, 0u, encode_leaf(tree, 0u));
        if (NODE_WIDTH == 8u) store_no_record(tree.records, 1u);
    }
    else if (!has_instances(tree))
    {
        BvhTriangle fetched = fetch_primitive(tree, 0u);
        if (!has_boxes(tree)) fetched = without_inactive_vertices(fetched);
        AT(tree.triangles, 0) = fetched;
    }
}
