// SPDX-License-Identifier: MIT
// The leaves that a tree is built from.
#ifndef TWINRAY_SHARED_LEAF_H
#define TWINRAY_SHARED_LEAF_H

// A primitive, which is both, or two triangles.
struct Leaf {
    uint first;
    uint second;
};
BUFFER_OF(Leaf, 4);

FUNC Leaf make_leaf(uint first, uint second) {
    Leaf leaf;
    leaf.first = first;
    leaf.second = second;
    return leaf;
}
FUNC bool has_two(Leaf leaf) { return leaf.first != leaf.second; }
#endif
