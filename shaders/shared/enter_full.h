// SPDX-License-Identifier: MIT
// Where a ray enters the children of a node of layout bvh4, whose boxes lie side by side in full precision.
#ifndef TWINRAY_SHARED_ENTER_FULL_H
#define TWINRAY_SHARED_ENTER_FULL_H
#include "shaders/shared/compressed.h"
#include "shaders/shared/group.h"

FUNC uint enter_full_box(REF(LeafBox) boxes, uint record, BoxRay ray, float t_min, float t_max, bool is_there, uint query)
{
    LeafBox box = load_box(boxes, record);
    float enter = 0.0f;
    float leave = 0.0f;
    cross_box(box.lo, box.hi, ray, t_min, t_max, enter, leave);
    return place_in_order(enter, leave, is_there, query);
}

FUNC ChildKeys enter_full(REF(LeafBox) boxes, CompressedRecord node, BoxRay ray, float t_min, float t_max, uint query)
{
    uint first = first_child_of(node);
    uint last = children_in(node) - 1u;
    ChildKeys keys;
    keys.key0 = enter_full_box(boxes, first, ray, t_min, t_max, true, query);
    keys.key1 = enter_full_box(boxes, first + 1u, ray, t_min, t_max, true, query) | 1u;
    keys.key2 = enter_full_box(boxes, first + min(2u, last), ray, t_min, t_max, last > 1u, query) | 2u;
    keys.key3 = enter_full_box(boxes, first + min(3u, last), ray, t_min, t_max, last > 2u, query) | 3u;
    return keys;
}
#endif
