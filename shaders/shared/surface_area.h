// SPDX-License-Identifier: MIT
// The surface-area cost of a tree: the areas of the boxes of all children, also leaves, over the area of the root's
// box: the expected number of boxes that a long random ray through the root enters below it (MacDonald, Booth 1990).
#ifndef TWINRAY_SHARED_SURFACE_AREA_H
#define TWINRAY_SHARED_SURFACE_AREA_H
#include "shaders/shared/bvh.h"

const uint AREA_GROUP = 256u;

// A box, and the areas of the boxes below it.
struct AreaItem {
    vec3 lo;  // lo > hi: empty
    vec3 hi;
    float sum;
};
BUFFER_OF(AreaItem, 4);

struct TreeCost {
    float now;
    float at_build;
};
BUFFER_OF(TreeCost, 4);

// Joins runs of AREA_GROUP items, two neighbours at a time: the tree that halves the sequence. Items without a box
// only bring their sums.
struct JoinAreasArgs {
    REF(AreaItem) items;
    REF(AreaItem) joined;  // one a group
    REF(GeometryBox) root;
    REF(TreeCost) kept;    // at_build, from the last build on
    REF(TreeCost) result;  // absent but in the last step
    uint count;
    uint is_build;
};

// One item for AREA_GROUP nodes of a tree, or AREA_GROUP records.
struct NodeAreasArgs {
    REF(Bvh) tree;
    REF(CompressedRecord) records;  // absent: binary nodes
    REF(AreaItem) items;
    uint count;
    uint reserved;
};

// Half the area of a box with these sides, about 1 long at most. Some are so small that their products, which devices
// may flush, do not count.
FUNC float or_zero(float side) { return side < 8.6736173798840355e-19f ? 0.0f : side; }  // 2^-60
FUNC float area_of_sides(vec3 sides) {
    vec3 s = vec3(or_zero(sides.x), or_zero(sides.y), or_zero(sides.z));
    PRECISE float area = s.x * s.y + s.y * s.z + s.z * s.x;
    return area;
}

// Returns half the area of a box in squares of `unit`, which keeps it in range. Neither too small nor infinite: else 0.
FUNC float half_area(vec3 lo, vec3 hi, float unit) {
    const float LARGEST_FLOAT = uintBitsToFloat(0x7f7fffffu);
    if (!(lo.x <= hi.x) || !(unit > 1e-37f && unit <= LARGEST_FLOAT)) return 0.0f;
    PRECISE vec3 size = (hi - lo) / unit;
    return area_of_sides(size);
}

FUNC float area_unit(vec3 lo, vec3 hi) {
    vec3 size = hi - lo;
    return max(size.x, max(size.y, size.z));
}

FUNC AreaItem join_areas(AreaItem a, AreaItem b, float unit) {
    bool both = a.lo.x <= a.hi.x && b.lo.x <= b.hi.x;
    AreaItem joined;
    joined.lo = min(a.lo, b.lo);
    joined.hi = max(a.hi, b.hi);
    joined.sum = a.sum + b.sum;
    if (both) joined.sum += half_area(a.lo, a.hi, unit) + half_area(b.lo, b.hi, unit);
    return joined;
}

FUNC AreaItem no_area() {
    AreaItem item;
    item.lo = vec3(uintBitsToFloat(0x7f800000u));
    item.hi = vec3(uintBitsToFloat(0xff800000u));
    item.sum = 0.0f;
    return item;
}
#endif
