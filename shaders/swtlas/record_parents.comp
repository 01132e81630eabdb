// SPDX-License-Identifier: MIT
// Stores the node above each record of finished trees.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/swtlas/slots.glsl"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { RefitArgs args; };

void visit(BuildTree tree, uint slot)
{
    uint base = 2u * tree.first;
    if (slot == 0u) AT(args.parents, base) = NOTHING;
    CompressedRecord record = load_record(tree.records, slot);
    if (is_leaf(record)) return;
    AT(args.missing, base + slot) = children_in(record);
    if (children_in(record) == 0u) return;
    ChildSlots slots = child_slots(record, second_half_of(tree.records, slot, record));
    DONT_UNROLL for (uint i = 0u; i < NODE_WIDTH; ++i)
        if (has_child(slots, i)) AT(args.parents, base + child_index(slots, i)) = slot;
}

void main()
{
    if (group_index() >= args.chunk_count) return;
    LeafChunk chunk = AT(args.chunks, group_index());
    BuildTree tree = AT(args.trees, chunk.tree);
    for (uint slot = slots_begin(tree, chunk) + gl_LocalInvocationIndex; slot < slots_end(tree, chunk);
         slot += BUILD_GROUP)
        visit(tree, slot);
}
