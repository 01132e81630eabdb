// SPDX-License-Identifier: MIT
// Where a ray enters the children of a node of layout bvh4, whose boxes lie side by side in full precision.
#ifndef TWINRAY_SHARED_ENTER_FULL_H
#define TWINRAY_SHARED_ENTER_FULL_H
#include "shaders/shared/compressed.h"
#include "shaders/shared/group.h"

FUNC uint enter_full_box(LeafBox box, BoxRay ray, float t_min, float t_max, bool is_there, uint query)
{
    float enter = 0.0f;
    float leave = 0.0f;
    cross_box(box.lo, box.hi, ray, t_min, t_max, enter, leave);
    return place_in_order(enter, leave, is_there, query);
}

FUNC ChildKeys enter_full(REF(LeafBox) boxes, CompressedRecord node, BoxRay ray, float t_min, float t_max, uint query)
{
    uint first = first_child_of(node);
    uint last = children_in(node) - 1u;
    uint key[4]; // a loop: unrolled, it takes some drivers minutes to compile
    for (uint i = 0u; i < 4u; i = i + 1u)
        key[i] = enter_full_box(load_box(boxes, first + min(i, last)), ray, t_min, t_max, i <= last, query) | i;
    ChildKeys keys;
    keys.key0 = key[0];
    keys.key1 = key[1];
    keys.key2 = key[2];
    keys.key3 = key[3];
    return keys;
}
#endif
