// SPDX-License-Identifier: MIT
// The leaves of a tree in order and the splits between them, for kernels whose args have them.
#ifndef TWINRAY_SWTLAS_SORTED_LEAVES_GLSL
#define TWINRAY_SWTLAS_SORTED_LEAVES_GLSL
#include "shaders/shared/node_child.h"
#include "shaders/shared/splits.h"

const uvec2 TREE_END = uvec2(~0u);  // the split beside the first and the last leaf

bool has_low_codes;  // leaves are also sorted by low codes

uvec2 split_of(BuildTree tree, uint position, uint code, uint next_code) {
    uint difference = 0u;
    if (has_low_codes && code == next_code)
        difference = AT(args.low_codes, AT(args.order, position)) ^ AT(args.low_codes, AT(args.order, position + 1u));
    return make_split(code ^ next_code, difference, position - tree.first);
}
uvec2 split_after(BuildTree tree, uint position) {
    return split_of(tree, position, AT(args.codes, position), AT(args.codes, position + 1u));
}
uvec2 split_before(BuildTree tree, uint position) {
    return position == tree.first ? TREE_END : split_after(tree, position - 1u);
}

// Finishes the tree, which is whole.
void finish(BuildTree tree, NodeChild root) {
    AT(tree.bvh, 0).root = root.child;
    AT(tree.bvh, 0).leaf_count = tree.count;
    AT(tree.bvh, 0).lo = root.box.lo;
    AT(tree.bvh, 0).hi = root.box.hi;
}
#endif
