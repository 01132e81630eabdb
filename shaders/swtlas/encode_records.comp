// SPDX-License-Identifier: MIT
// The records of the leaves.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/collapse.h"
#include "shaders/swtlas/ahead.glsl"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;
layout(push_constant, scalar) uniform Push { EncodeRecordsArgs args; };

// A block's part of the order, places, and of its triangles the indices and a vertex.
void load_ahead(BuildBlock block, BuildTree tree)
{
    uint stride = gl_WorkGroupSize.x;
    load_lines(address_at(args.order.address, block.first, 4u), block.count * 4u, stride);
    load_lines(address_at(args.places.address, block.first, 4u), block.count * 4u, stride);
    uint found = 0u;
    for (uint first = gl_LocalInvocationID.x; first < block.count; first += LOADS_ABREAST * stride)
    {
        uint triangles[LOADS_ABREAST];
        UNROLL for (uint i = 0u; i < LOADS_ABREAST; ++i)
        {
            uint place = min(first + i * stride, block.count - 1u);
            triangles[i] = AT(args.order, block.first + place) - tree.first;
        }
        uint corners[LOADS_ABREAST];
        UNROLL for (uint i = 0u; i < LOADS_ABREAST; ++i) corners[i] = AT(tree.indices, 3u * triangles[i]);
        UNROLL for (uint i = 0u; i < LOADS_ABREAST; ++i) found ^= floatBitsToUint(AT(tree.positions, 3u * corners[i]));
    }
    keep_loads(found);
}

void main()
{
    BuildBlock block = AT(args.blocks, min(group_index(), args.block_count - 1u));
    BuildTree tree = AT(args.trees, block.tree);
    if (group_index() >= args.block_count) return;
    if (LOADS_AHEAD && !has_boxes(tree)) load_ahead(block, tree);
    for (uint i = gl_LocalInvocationID.x; i < block.count; i += gl_WorkGroupSize.x)
    {
        uint position = block.first + i;
        store_record(tree.records, AT(args.places, position), encode_leaf(tree, AT(args.order, position) - tree.first));
    }
}
