// SPDX-License-Identifier: MIT
// Where a ray enters the children of a node of layout compressed4, or of half a one of compressed8.
#ifndef TWINRAY_SHARED_ENTER_COMPRESSED_H
#define TWINRAY_SHARED_ENTER_COMPRESSED_H
#include "shaders/shared/compressed.h"
#include "shaders/shared/node_group.h"

// The grid of a node as a ray sees it: along each axis the distance of a plane is plane * scale + base. The scale is
// that of near planes for all: it leaves far ones 2^-20 of at most 255 cells nearer, and they are a 256th of a cell
// farther off than they must be.
struct SeenGrid
{
    vec3 scale;
    vec3 near_base;
    vec3 far_base;
    uvec3 near_planes; // of the four children, 8 bits each
    uvec3 far_planes;
};

FUNC void see_planes(INOUT(SeenGrid) grid, CompressedRecord planes, BoxRay ray)
{
    bool flip_x = ray.near_inverse.x < 0.0f;
    bool flip_y = ray.near_inverse.y < 0.0f;
    bool flip_z = ray.near_inverse.z < 0.0f;
    grid.near_planes = uvec3(flip_x ? planes.b.y : planes.b.x, flip_y ? planes.b.w : planes.b.z,
                             flip_z ? planes.c.y : planes.c.x);
    grid.far_planes = uvec3(flip_x ? planes.b.x : planes.b.y, flip_y ? planes.b.z : planes.b.w,
                            flip_z ? planes.c.x : planes.c.y);
}

FUNC SeenGrid grid_of(CompressedRecord node, BoxRay ray)
{
    SeenGrid grid;
    vec3 origin = grid_origin(node);
    vec3 cell = grid_cell(node);
    grid.scale = cell * ray.near_inverse;
    grid.near_base = (origin - ray.near_origin) * ray.near_inverse;
    grid.far_base = (origin - ray.far_origin) * ray.far_inverse;
    see_planes(grid, node, ray);
    return grid;
}

FUNC float distance_along(uint planes, uint shift, float scale, float base)
{
    return FMA(float(planes >> shift & 0xffu), scale, base);
}

// Where the ray crosses the box of child `shift / 8`, between t_min and t_max in t * ray.t_scale: as cross_box of
// ray_space.h.
FUNC vec2 cross_planes(SeenGrid grid, uint shift, float t_min, float t_max)
{
    float near_x = distance_along(grid.near_planes.x, shift, grid.scale.x, grid.near_base.x);
    float near_y = distance_along(grid.near_planes.y, shift, grid.scale.y, grid.near_base.y);
    float near_z = distance_along(grid.near_planes.z, shift, grid.scale.z, grid.near_base.z);
    float far_x = distance_along(grid.far_planes.x, shift, grid.scale.x, grid.far_base.x);
    float far_y = distance_along(grid.far_planes.y, shift, grid.scale.y, grid.far_base.y);
    float far_z = distance_along(grid.far_planes.z, shift, grid.scale.z, grid.far_base.z);
    return vec2(latest_of(t_min, near_x, near_y, near_z), earliest_of(t_max, far_x, far_y, far_z));
}
FUNC bool crosses_planes(SeenGrid grid, uint shift, float t_min, float t_max)
{
    vec2 crossing = cross_planes(grid, shift, t_min, t_max);
    return !(crossing.y < crossing.x); // true for NaN, too: then the children are looked at
}
FUNC uint enter_planes(SeenGrid grid, uint shift, float t_min, float t_max, bool is_there, uint query)
{
    vec2 crossing = cross_planes(grid, shift, t_min, t_max);
    return visit_order(crossing.x, crossing.y, is_there, query);
}

FUNC ChildKeys enter_compressed(CompressedRecord node, BoxRay ray, float t_min, float t_max, uint query)
{
    SeenGrid grid = grid_of(node, ray);
    PRECISE float first = t_min * ray.t_scale;
    PRECISE float last = t_max * ray.t_scale;
    // All four are computed, then chosen: branches cost more.
    // Boxes that are not there may be crossed, too: a ray's padding can be wider than the grid.
    uint children = children_in(node);
    ChildKeys keys;
    keys.key0 = enter_planes(grid, 0u, first, last, true, query);
    keys.key1 = enter_planes(grid, 8u, first, last, true, query) | 1u;
    keys.key2 = enter_planes(grid, 16u, first, last, children > 2u, query) | 2u;
    keys.key3 = enter_planes(grid, 24u, first, last, children > 3u, query) | 3u;
    return keys;
}
#endif
