// SPDX-License-Identifier: MIT
// The splits between the sorted leaves of a tree.
#ifndef TWINRAY_SHARED_SPLITS_H
#define TWINRAY_SHARED_SPLITS_H
#include "shaders/shared/build.h"
#include "shaders/shared/morton.h"
#include "twinray/glsl/word64.h"

FUNC LeafBox bounds_of(CentroidBounds bits) {
    LeafBox bounds;
    bounds.lo = vec3(from_ordered_bits(bits.lo.x), from_ordered_bits(bits.lo.y), from_ordered_bits(bits.lo.z));
    bounds.hi = vec3(from_ordered_bits(bits.hi.x), from_ordered_bits(bits.hi.y), from_ordered_bits(bits.hi.z));
    return bounds;
}

// Returns the split between neighbours in sorted order, larger = higher up: the highest bit in which their codes
// differ, for equal codes the highest in which low codes do, and if these are equal too, the highest in which their
// positions do. Only the highest bit counts, and that of two neighbours of a range of leaves is never the same.
FUNC uvec2 make_split(uint of_code, uint of_low_code, uint position) {
    uint of_position = position ^ (position + 1u);  // 25 bits
    uint lower = of_low_code != 0u ? (uint(findMSB(of_low_code)) + 1u) << 25u : of_position;
    return uvec2(lower, of_code);
}
// A tree below a split has at most one node for each lower bit on any way down.
FUNC uint highest_below(uvec2 split) {
    uint of_code = split.y;
    uint lower = split.x;
    if (of_code != 0u) return uint(findMSB(of_code)) + 56u;
    return lower >> 25u != 0u ? (lower >> 25u) + 25u : uint(findMSB(lower)) + 1u;
}
#endif
