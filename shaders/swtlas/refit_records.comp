// SPDX-License-Identifier: MIT
// New records for an old topology: each leaf climbs with its box, and of the children that arrive at a node the last goes
// on with all.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/collapse.h"
#include "shaders/swtlas/slots.glsl"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitRecordsArgs args; };

// The boxes as seen by all groups, not through caches of one.
layout(buffer_reference, scalar, buffer_reference_align = 4) coherent buffer SharedBoxes { LeafBox items[]; };

LeafBox refit_leaf(BuildTree tree, uint slot, uint leaf)
{
    if (has_instances(tree)) return AT(args.boxes, tree.first + leaf);
    store_record(tree.records, slot, encode_leaf(tree, leaf));
    return box_of_primitive(tree, leaf);
}

LeafBox refit_node(BuildTree tree, uint slot, SharedBoxes boxes)
{
    CompressedRecord node = load_record(tree.records, slot);
    NodeChildren children;
    children.count = children_in(node);
    UNROLL for (uint i = 0u; i < 4u; ++i)
    {
        children.box[i] = empty_box();
        if (i < children.count) children.box[i] = boxes.items[2u * tree.first + first_child_of(node) + i];
    }
    store_record(tree.records, slot, encode_node(children, first_child_of(node)));
    return box_around(children);
}

void climb(BuildTree tree, uint slot, LeafBox box)
{
    SharedBoxes boxes = SharedBoxes(uint64_t(args.slot_boxes));
    uint base = 2u * tree.first;
    for (uint parent = AT(args.parents, base + slot); parent != NOTHING; parent = AT(args.parents, base + slot))
    {
        boxes.items[base + slot] = box;
        keep_box(tree, slot, box);
        memoryBarrierBuffer();
        if (atomicAdd(AT(args.missing, base + parent), 0xffffffffu) != 1u) return;
        memoryBarrierBuffer();
        slot = parent;
        box = refit_node(tree, slot, boxes);
    }
    AT(tree.bvh, 0).lo = box.lo;
    AT(tree.bvh, 0).hi = box.hi;
}

void main()
{
    if (group_index() >= args.block_count) return;
    BuildBlock block = AT(args.blocks, group_index());
    BuildTree tree = AT(args.trees, block.tree);
    for (uint slot = slots_begin(tree, block) + gl_LocalInvocationIndex; slot < slots_end(tree, block); slot += BUILD_GROUP)
    {
        CompressedRecord record = load_record(tree.records, slot);
        if (is_leaf(record)) climb(tree, slot, refit_leaf(tree, slot, index_in(record)));
    }
}
