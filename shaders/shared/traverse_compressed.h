// SPDX-License-Identifier: MIT
// Traversal of a SwScene of layout compressed4: one loop over nodes, primitives and instances, one record an iteration.
// The children that a ray has still to visit are one word: where they lie, and in which order.
#ifndef TWINRAY_SHARED_TRAVERSE_COMPRESSED_H
#define TWINRAY_SHARED_TRAVERSE_COMPRESSED_H
#include "shaders/shared/compressed.h"
#include "shaders/shared/visit.h"

// A node leaves one group at most, so the deepest path of each level, the mark between them and the bottom.
const uint GROUP_STACK_SIZE = 2u * DEEPEST_TREE + 4u;

// A group: where the siblings begin (25 bits), up to three of them to visit, in order (2 bits each, the last one repeated),
// and 1 at the top. Else there is none:
const uint BOTTOM = 0u;
const uint LEAVE_INSTANCE = 1u;
const uint NO_ENTRY = 0x7f800000u; // infinity, and what is larger: no hit is reported there
FUNC bool is_waiting(uint group) { return group >= 0x80000000u; }
FUNC uint make_group(uint siblings, uint second, uint third, uint fourth)
{
    return 0x80000000u | fourth << 29u | third << 27u | second << 25u | siblings;
}
FUNC uint next_of(uint group) { return (group & 0x1ffffffu) + (group >> 25u & 3u); }
// Without the next one.
FUNC uint rest_of(uint group)
{
    bool is_last = ((group >> 25u ^ group >> 27u) & 3u) == 0u;
    return is_last ? BOTTOM : (group & 0xe1ffffffu) | (group >> 2u & 0x1e000000u);
}

// The grid of a node as a ray sees it: along each axis the distance of a plane is plane * scale + base.
struct SeenGrid
{
    vec3 near_scale;
    vec3 far_scale;
    vec3 near_base;
    vec3 far_base;
    uvec3 near_planes; // of the four children, 8 bits each
    uvec3 far_planes;
};

FUNC SeenGrid grid_of(CompressedRecord node, RaySpace space)
{
    SeenGrid grid;
    vec3 origin = grid_origin(node);
    vec3 cell = grid_cell(node);
    grid.near_scale = cell * space.near_inverse;
    grid.far_scale = cell * space.far_inverse;
    grid.near_base = (origin - space.near_origin) * space.near_inverse;
    grid.far_base = (origin - space.far_origin) * space.far_inverse;
    bool flip_x = space.near_inverse.x < 0.0f;
    bool flip_y = space.near_inverse.y < 0.0f;
    bool flip_z = space.near_inverse.z < 0.0f;
    grid.near_planes = uvec3(flip_x ? node.b.y : node.b.x, flip_y ? node.b.w : node.b.z, flip_z ? node.c.y : node.c.x);
    grid.far_planes = uvec3(flip_x ? node.b.x : node.b.y, flip_y ? node.b.z : node.b.w, flip_z ? node.c.x : node.c.y);
    return grid;
}

FUNC float distance_along(uint planes, uint shift, float scale, float base)
{
    return FMA(float(planes >> shift & 0xffu), scale, base);
}

// Where the ray enters child `shift / 8` of the node, as the bits of t without the last two, or NO_ENTRY: as enter_box of
// intersect.h.
FUNC uint enter_child(SeenGrid grid, uint shift, float t_min, float t_max)
{
    float near_x = distance_along(grid.near_planes.x, shift, grid.near_scale.x, grid.near_base.x);
    float near_y = distance_along(grid.near_planes.y, shift, grid.near_scale.y, grid.near_base.y);
    float near_z = distance_along(grid.near_planes.z, shift, grid.near_scale.z, grid.near_base.z);
    float far_x = distance_along(grid.far_planes.x, shift, grid.far_scale.x, grid.far_base.x);
    float far_y = distance_along(grid.far_planes.y, shift, grid.far_scale.y, grid.far_base.y);
    float far_z = distance_along(grid.far_planes.z, shift, grid.far_scale.z, grid.far_base.z);
    float enter = latest_of(t_min, near_x, near_y, near_z);
    return enter <= earliest_of(t_max, far_x, far_y, far_z) ? floatBitsToUint(enter) & ~3u : NO_ENTRY;
}

// Less comes first.
FUNC void sort_pair(INOUT(uint) a, INOUT(uint) b)
{
    uint less = min(a, b);
    b = max(a, b);
    a = less;
}

// How many children the ray enters between t_min and t_max, in t * space.t_scale, and the first of them; the others become
// `group`.
FUNC uint entered_children(CompressedRecord node, RaySpace space, float t_min, float t_max, INOUT(uint) nearest,
                           INOUT(uint) group)
{
    SeenGrid grid = grid_of(node, space);
    uint children = children_in(node);
    // The number of the child in the last bits of where it is entered.
    uint key0 = enter_child(grid, 0u, t_min, t_max);
    uint key1 = enter_child(grid, 8u, t_min, t_max) | 1u;
    uint key2 = children > 2u ? enter_child(grid, 16u, t_min, t_max) | 2u : NO_ENTRY;
    uint key3 = children > 3u ? enter_child(grid, 24u, t_min, t_max) | 3u : NO_ENTRY;
    uint count = (key0 < NO_ENTRY ? 1u : 0u) + (key1 < NO_ENTRY ? 1u : 0u) + (key2 < NO_ENTRY ? 1u : 0u) + (key3 < NO_ENTRY ? 1u : 0u);
    sort_pair(key0, key1);
    sort_pair(key2, key3);
    sort_pair(key0, key2);
    sort_pair(key1, key3);
    sort_pair(key1, key2);
    nearest = node.c.z + (key0 & 3u);
    key2 = count > 2u ? key2 : key1;
    group = make_group(node.c.z, key1 & 3u, key2 & 3u, (count > 3u ? key3 : key2) & 3u);
    return count;
}

FUNC Hit traverse_compressed(SwScene scene, Ray ray, TraceOptions options)
{
    Search search = begin_search(ray);
    if (scene.bvh.root == NOTHING) return search.best;
    bool has_top = (options.features & FEATURE_INSTANCES) != 0u;
    RaySpace space;
    REF(CompressedRecord) records = scene.records;
    InInstance inside;
    if (has_top) space = world_space(scene, ray);
    else
    {
        SwInstance instance = AT(scene.instances, 0);
        if (!is_visible(instance, options)) return search.best;
        inside = enter_instance(instance, 0u, options);
        space = space_in(instance, inside, ray, options);
        records = instance.records;
    }
    bool in_instance = !has_top;

    uint stack[GROUP_STACK_SIZE];
    uint height = 1u;
    stack[0] = BOTTOM;
    uint group = BOTTOM; // the last one, if it is waiting
    uint cursor = 0u;
    for (;;)
    {
        CompressedRecord record = load_record(records, cursor);
        bool descend = false;
        if (!is_leaf(record))
        {
            uint others = BOTTOM;
            uint count = entered_children(record, space, search.t_min * space.t_scale, search.t_best * space.t_scale, cursor, others);
            if (count > 1u)
            {
                stack[height] = group;
                height = height + (is_waiting(group) ? 1u : 0u);
                group = others;
            }
            descend = count > 0u;
        }
        else if (!has_top || in_instance)
        {
            if (visit_leaf(primitive_of(record), inside, space, options, search) && options.query == QUERY_ANY) break;
        }
        else
        {
            uint index = record.a.w & ~LEAF_BIT;
            SwInstance instance = AT(scene.instances, index);
            if (is_visible(instance, options))
            {
                inside = enter_instance(instance, index, options);
                space = space_in(instance, inside, ray, options);
                records = instance.records;
                stack[height] = group;
                height = height + (is_waiting(group) ? 1u : 0u);
                stack[height] = LEAVE_INSTANCE;
                height = height + 1u;
                group = BOTTOM;
                in_instance = true;
                cursor = 0u;
                descend = true;
            }
        }
        if (descend) continue;
        if (!is_waiting(group))
        {
            height = height - 1u;
            group = stack[height];
            if (has_top && group == LEAVE_INSTANCE)
            {
                space = world_space(scene, ray);
                records = scene.records;
                in_instance = false;
                height = height - 1u;
                group = stack[height];
            }
            if (group == BOTTOM) break;
        }
        cursor = next_of(group);
        group = rest_of(group);
    }
    return search.best;
}
#endif
