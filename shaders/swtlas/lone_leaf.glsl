// SPDX-License-Identifier: MIT
// A tree of one leaf.
#ifndef TWINRAY_SWTLAS_LONE_LEAF_GLSL
#define TWINRAY_SWTLAS_LONE_LEAF_GLSL
#include "shaders/shared/collapse.h"
layout(constant_id = NODE_WIDTH_CONSTANT) const uint NODE_WIDTH = 4u;

// Stores all of it except the leaf, which is record 0 if there are records.
void store_lone_tree(REF(Bvh) bvh, REF(CompressedRecord) records, LeafBox box)
{
    AT(bvh, 0).root = is_absent(records) ? LEAF_BIT : 0u;
    AT(bvh, 0).leaf_count = 1u;
    AT(bvh, 0).lo = box.lo;
    AT(bvh, 0).hi = box.hi;
    if (NODE_WIDTH == 8u && !is_absent(records)) store_no_record(records, 1u);
}
#endif
