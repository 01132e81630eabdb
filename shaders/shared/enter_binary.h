// SPDX-License-Identifier: MIT
// Layout bvh2: which children of a node a ray enters, and the way back to a node from the root.
#ifndef TWINRAY_SHARED_ENTER_BINARY_H
#define TWINRAY_SHARED_ENTER_BINARY_H
#include "shaders/shared/group.h"

FUNC uint enter_binary_box(vec3 lo, vec3 hi, BoxRay ray, Search search, uint query)
{
    float enter = 0.0f;
    float leave = 0.0f;
    cross_box(lo, hi, ray, search.t_min, search.t_best, enter, leave);
    return place_in_order(enter, leave, true, query);
}

FUNC ChildKeys enter_binary(BvhNode node, BoxRay ray, Search search, uint query)
{
    ChildKeys keys;
    keys.key0 = enter_binary_box(node.lo0, node.hi0, ray, search, query);
    keys.key1 = enter_binary_box(node.lo1, node.hi1, ray, search, query) | 1u;
    keys.key2 = NO_ENTRY;
    keys.key3 = NO_ENTRY;
    return keys;
}

// Below which child of `node` the edge `target` lies.
FUNC uint binary_child_towards(REF(BvhNode) nodes, uint node, uint target)
{
    uint edge = target;
    while (parent_of_edge(edge) != node) edge = edge_of(nodes, parent_of_edge(edge));
    return edge & 1u;
}
#endif
