// SPDX-License-Identifier: MIT
// The children of a node that a ray enters, of any layout: the first one, and the others as an entry of the stack.
#ifndef TWINRAY_SHARED_ENTERED_CHILDREN_H
#define TWINRAY_SHARED_ENTERED_CHILDREN_H
#include "shaders/shared/encode_node.h"
#include "shaders/shared/visit.h"

// The children of a node that a ray still has to visit, in order, as one word, an entry of the stack: the index of the
// first sibling (26 bits), and up to three of them to visit, the next one in the lowest bits (2 bits each, the last one
// repeated). No siblings begin at the root, so that no group is EMPTY_NODE_GROUP.
const uint EMPTY_NODE_GROUP = 0u;
FUNC uint make_node_group(uint siblings, uint second, uint third, uint fourth) {
    return siblings << 6u | fourth << 4u | third << 2u | second;
}
FUNC uint next_of(uint group) { return (group >> 6u) + (group & 3u); }
// Removes the next one; EMPTY_NODE_GROUP: there is no other.
FUNC uint rest_of(uint group) {
    bool is_last = ((group ^ group >> 2u) & 3u) == 0u;
    return is_last ? EMPTY_NODE_GROUP : (group & 0xfffffff0u) | (group >> 2u & 15u);
}

// The positions of a node's children in order, the least first (see visit_order), each with its number in the last two
// bits; NO_ENTRY or more: the ray does not enter it.
struct ChildKeys {
    uint key0;
    uint key1;
    uint key2;
    uint key3;
};

FUNC void sort_pair(INOUT(uint) a, INOUT(uint) b) {
    uint less = min(a, b);
    b = max(a, b);
    a = less;
}

FUNC void sort_keys(INOUT(ChildKeys) keys) {
    sort_pair(keys.key0, keys.key1);
    sort_pair(keys.key2, keys.key3);
    sort_pair(keys.key0, keys.key2);
    sort_pair(keys.key1, keys.key3);
    sort_pair(keys.key1, keys.key2);
}

// All entered children but the first, of sorted keys, as a group. `siblings`: the index of the first sibling.
FUNC uint node_group_of(ChildKeys keys, uint siblings) {
    if (keys.key1 >= NO_ENTRY) return EMPTY_NODE_GROUP;
    uint third = keys.key2 < NO_ENTRY ? keys.key2 : keys.key1;
    return make_node_group(siblings, keys.key1 & 3u, third & 3u, (keys.key3 < NO_ENTRY ? keys.key3 : third) & 3u);
}

FUNC uint key_of(ChildKeys keys, uint child) {
    uint low = child == 0u ? keys.key0 : keys.key1;
    uint high = child == 2u ? keys.key2 : keys.key3;
    return child < 2u ? low : high;
}

// Returns the key that puts `child` first, and then those that come after it, as in a traversal that continued to it.
FUNC uint key_from(uint key, uint first, uint number, uint child) {
    return number == child ? child : (key > first ? key : NO_ENTRY);
}
FUNC ChildKeys keys_from(ChildKeys keys, uint child) {
    uint first = key_of(keys, child);
    keys.key0 = key_from(keys.key0, first, 0u, child);
    keys.key1 = key_from(keys.key1, first, 1u, child);
    keys.key2 = key_from(keys.key2, first, 2u, child);
    keys.key3 = key_from(keys.key3, first, 3u, child);
    return keys;
}

// The grid of a node of layout compressed4, or of half a one of compressed8, as a ray sees it: along each axis the
// distance of a plane is plane * scale + base. The scale is that of near planes for all: it leaves far ones 2^-20 of at
// most 255 cells nearer, and they are a 256th of a cell farther off than they must be.
struct SeenGrid {
    vec3 scale;
    vec3 near_base;
    vec3 far_base;
    uvec3 near_planes;  // of the four children, 8 bits each
    uvec3 far_planes;
};

FUNC void see_planes(INOUT(SeenGrid) grid, CompressedRecord planes, BoxRay ray) {
    bool flip_x = ray.near_inverse.x < 0.0f;
    bool flip_y = ray.near_inverse.y < 0.0f;
    bool flip_z = ray.near_inverse.z < 0.0f;
    grid.near_planes =
        uvec3(flip_x ? planes.b.y : planes.b.x, flip_y ? planes.b.w : planes.b.z, flip_z ? planes.c.y : planes.c.x);
    grid.far_planes =
        uvec3(flip_x ? planes.b.x : planes.b.y, flip_y ? planes.b.z : planes.b.w, flip_z ? planes.c.x : planes.c.y);
}

FUNC SeenGrid grid_of(CompressedRecord node, BoxRay ray) {
    SeenGrid grid;
    vec3 origin = grid_origin(node);
    vec3 cell = grid_cell(node);
    grid.scale = cell * ray.near_inverse;
    grid.near_base = (origin - ray.near_origin) * ray.near_inverse;
    grid.far_base = (origin - ray.far_origin) * ray.far_inverse;
    see_planes(grid, node, ray);
    return grid;
}

FUNC float distance_along(uint planes, uint shift, float scale, float base) {
    return FMA(float(planes >> shift & 0xffu), scale, base);
}

// Returns the interval in which the ray crosses the box of child `shift / 8`, between t_min and t_max in t *
// ray.t_scale, like cross_box of ray_space.h.
FUNC vec2 cross_planes(SeenGrid grid, uint shift, float t_min, float t_max) {
    float near_x = distance_along(grid.near_planes.x, shift, grid.scale.x, grid.near_base.x);
    float near_y = distance_along(grid.near_planes.y, shift, grid.scale.y, grid.near_base.y);
    float near_z = distance_along(grid.near_planes.z, shift, grid.scale.z, grid.near_base.z);
    float far_x = distance_along(grid.far_planes.x, shift, grid.scale.x, grid.far_base.x);
    float far_y = distance_along(grid.far_planes.y, shift, grid.scale.y, grid.far_base.y);
    float far_z = distance_along(grid.far_planes.z, shift, grid.scale.z, grid.far_base.z);
    return vec2(latest_of(t_min, near_x, near_y, near_z), earliest_of(t_max, far_x, far_y, far_z));
}
FUNC bool crosses_planes(SeenGrid grid, uint shift, float t_min, float t_max) {
    vec2 crossing = cross_planes(grid, shift, t_min, t_max);
    return !(crossing.y < crossing.x);  // also true for NaN: then the children are looked at
}
FUNC uint enter_planes(SeenGrid grid, uint shift, float t_min, float t_max, bool is_there, uint query) {
    vec2 crossing = cross_planes(grid, shift, t_min, t_max);
    return visit_order(crossing.x, crossing.y, is_there, query);
}

// Returns the children of a node of layout compressed4, by where the ray enters them.
FUNC ChildKeys enter_compressed(CompressedRecord node, BoxRay ray, float t_min, float t_max, uint query) {
    SeenGrid grid = grid_of(node, ray);
    PRECISE float first = t_min * ray.t_scale;
    PRECISE float last = t_max * ray.t_scale;
    // All four are computed, then chosen: branches cost more.
    // Boxes that do not exist may also be crossed: a ray's padding can be wider than the grid.
    uint children = children_in(node);
    ChildKeys keys;
    keys.key0 = enter_planes(grid, 0u, first, last, true, query);
    keys.key1 = enter_planes(grid, 8u, first, last, true, query) | 1u;
    keys.key2 = enter_planes(grid, 16u, first, last, children > 2u, query) | 2u;
    keys.key3 = enter_planes(grid, 24u, first, last, children > 3u, query) | 3u;
    return keys;
}

// Layout compressed8: children of a node that wait on the stack, as the first of two words of an entry (the other is
// where the children begin): in the lowest 8 bits those to visit, in order; then ChildSlots::mask, and the ray's
// octant.
FUNC uint make_visits(uint in_order, uint slots, uint octant) { return in_order | slots << 8u | octant << 24u; }
FUNC uint octant_in(uint visits) { return visits >> 24u; }
FUNC uint next_slot(uint visits) { return uint(findLSB(visits)) ^ octant_in(visits); }
// Removes the next one; EMPTY_NODE_GROUP: there is no other.
FUNC uint rest_of_visits(uint visits) {
    uint rest = visits & (visits - 1u);
    return (rest & 0xffu) == 0u ? EMPTY_NODE_GROUP : rest;
}
FUNC ChildSlots slots_of_visits(uint visits, uint first) {
    ChildSlots slots;
    slots.first = first;
    slots.mask = visits >> 8u & 0xffffu;
    return slots;
}

FUNC uint octant_at(CompressedRecord second_half, BoxRay ray) {
    uint negative = (ray.near_inverse.x < 0.0f ? 1u : 0u) | (ray.near_inverse.y < 0.0f ? 2u : 0u) |
                    (ray.near_inverse.z < 0.0f ? 4u : 0u);
    return octant_of(negative, second_half.a.x >> 16u);
}

// Returns the slots of a half of the node that the ray crosses, from bit 0 on.
FUNC uint slots_crossed(SeenGrid grid, float first, float last) {
    uint slots = 0u;
    UNROLL for (uint slot = 0u; slot < 4u; slot = slot + 1u) slots =
        slots | (crosses_planes(grid, 8u * slot, first, last) ? 1u << slot : 0u);
    return slots;
}

// Returns the children that the ray enters, as visits; 0: none.
FUNC uint enter_wide(CompressedRecord node, CompressedRecord second_half, BoxRay ray, float t_min, float t_max) {
    PRECISE float first = t_min * ray.t_scale;
    PRECISE float last = t_max * ray.t_scale;
    SeenGrid grid = grid_of(node, ray);
    uint crossed = slots_crossed(grid, first, last);
    see_planes(grid, second_half, ray);
    crossed = crossed | slots_crossed(grid, first, last) << 4u;
    // Boxes that do not exist may also be crossed: a ray's padding can be wider than the grid.
    uint slots = second_half.a.x & 0xffffu;
    uint octant = octant_at(second_half, ray);
    return make_visits(in_order_of_octant(crossed & slots, octant), slots, octant);
}

// Returns the child in `slot`, and those that come after it, as in a traversal that continued to it.
FUNC uint visits_from(uint visits, uint slot) {
    uint bit = 1u << (slot ^ octant_in(visits));
    return (visits & ~((bit << 1u) - 1u)) | bit;
}

const uint ROOT_EDGE = 0u;  // in every layout; beside the root there is nothing that a stack could lose

// A tree of one level; of its arrays a layout has some.
struct SwTree {
    REF(BvhNode) nodes;
    REF(BvhTriangle) triangles;
    REF(CompressedRecord) records;
    Floats vertices;
    uint root;
};

// A node or leaf of a tree: the number of a record, for both, in layout compressed8 with LEAF_BIT where it is known to
// be a leaf, and with SECOND_BIT the second triangle of a leaf; in layout bvh2 a child and its edge.
const uint SECOND_BIT = INSTANCE_BIT;
struct TreePosition {
    uint item;
    uint edge;
};

FUNC TreePosition at_record(uint index) {
    TreePosition at;
    at.item = index;
    at.edge = index;
    return at;
}
FUNC TreePosition at_root(SwTree tree, bool is_binary) {
    TreePosition at;
    at.item = is_binary ? tree.root : 0u;
    at.edge = ROOT_EDGE;
    return at;
}

FUNC SwTree top_tree(SwTlasHeader scene) {
    SwTree tree;
    tree.nodes = scene.bvh.nodes;
    tree.triangles = REF(BvhTriangle)(scene.instances.address);  // read of no leaf: they are instances
    tree.records = scene.records;
    tree.vertices = Floats(scene.instances.address);
    tree.root = scene.bvh.root;
    return tree;
}
FUNC SwTree tree_of(SwInstance instance) {
    SwTree tree;
    tree.nodes = instance.nodes;
    tree.triangles = instance.triangles;
    tree.records = instance.records;
    tree.vertices = instance.vertices;
    tree.root = instance.root;
    return tree;
}

FUNC bool is_binary(SwTlasHeader scene, TraceOptions options) {
    bool may_be = (options.features & FEATURE_BVH2) != 0u;
    bool may_have_records = (options.features & (FEATURE_COMPRESSED | FEATURE_COMPRESSED8)) != 0u;
    return may_be && (!may_have_records || is_absent(scene.records));
}
FUNC bool may_be_wide(TraceOptions options) { return (options.features & FEATURE_COMPRESSED8) != 0u; }
FUNC bool is_surely_wide(TraceOptions options) {
    return (options.features & (FEATURE_COMPRESSED | FEATURE_COMPRESSED8 | FEATURE_BVH2)) == FEATURE_COMPRESSED8;
}

// The children of a node that the ray enters, the first one first, and the rest as an entry of the stack.
struct EnteredChildren {
    TreePosition first;
    bool is_entered;
    uint others;    // or EMPTY_NODE_GROUP
    uint siblings;  // in layout compressed8 the entry's other word, else 0
};

// `target`: not NOTHING, but the node or leaf that the ray is on its way back to.
FUNC EnteredChildren children_of_record(CompressedRecord record, SwTree tree, BoxRay ray, Search search, uint target,
                                        TraceOptions options) {
    ChildKeys keys = enter_compressed(record, ray, search.t_min, search.t_best, options.query);
    if (target != NOTHING) {
        ChildSlots slots;
        slots.first = first_child_of(record);
        slots.mask = (1u << children_in(record)) - 1u;
        keys = keys_from(keys, slot_towards(tree.records, slots, target));
    }
    sort_keys(keys);
    EnteredChildren children;
    children.first = at_record(first_child_of(record) + (keys.key0 & 3u));
    children.is_entered = keys.key0 < NO_ENTRY;
    children.others = node_group_of(keys, first_child_of(record));
    children.siblings = 0u;
    return children;
}

FUNC TreePosition at_next_of_visits(uint visits, uint first) {
    ChildSlots slots = slots_of_visits(visits, first);
    uint slot = next_slot(visits);
    TreePosition at = at_record(child_index(slots, slot));
    if ((slots.mask >> slot & 0x100u) == 0u) at.item = at.item | LEAF_BIT;
    return at;
}

FUNC EnteredChildren children_of_wide(CompressedRecord record, CompressedRecord second_half, SwTree tree, BoxRay ray,
                                      Search search, uint target) {
    uint visits = enter_wide(record, second_half, ray, search.t_min, search.t_best);
    if (target != NOTHING)
        visits = visits_from(visits, slot_towards(tree.records, child_slots(record, second_half), target));
    EnteredChildren children;
    children.siblings = first_child_of(record);
    children.first = at_next_of_visits(visits, children.siblings);
    children.is_entered = (visits & 0xffu) != 0u;
    children.others = rest_of_visits(visits);
    return children;
}

FUNC uint enter_binary_box(vec3 lo, vec3 hi, BoxRay ray, Search search, uint query) {
    vec2 crossing = cross_box(lo, hi, ray, search.t_min, search.t_best);
    return visit_order(crossing.x, crossing.y, true, query);
}

FUNC ChildKeys enter_binary(BvhNode node, BoxRay ray, Search search, uint query) {
    ChildKeys keys;
    keys.key0 = enter_binary_box(node.lo0, node.hi0, ray, search, query);
    keys.key1 = enter_binary_box(node.lo1, node.hi1, ray, search, query) | 1u;
    keys.key2 = NO_ENTRY;
    keys.key3 = NO_ENTRY;
    return keys;
}

// Returns the child of `node` that the edge `target` is below.
FUNC uint binary_child_towards(REF(BvhNode) nodes, uint node, uint target) {
    uint edge = target;
    while (parent_of_edge(edge) != node) edge = edge_of(nodes, parent_of_edge(edge));
    return edge & 1u;
}

FUNC EnteredChildren children_of_node(uint index, SwTree tree, BoxRay ray, Search search, uint target,
                                      TraceOptions options) {
    BvhNode node = load_node(tree.nodes, index);
    ChildKeys keys = enter_binary(node, ray, search, options.query);
    if (target != NOTHING) keys = keys_from(keys, binary_child_towards(tree.nodes, index, target));
    sort_pair(keys.key0, keys.key1);
    uint side = keys.key0 & 1u;
    EnteredChildren children;
    children.first.item = child_of(node, side).child;
    children.first.edge = make_edge(index, side);
    children.is_entered = keys.key0 < NO_ENTRY;
    children.others = keys.key1 < NO_ENTRY ? make_edge(index, side ^ 1u) : EMPTY_NODE_GROUP;
    children.siblings = 0u;
    return children;
}
#endif
