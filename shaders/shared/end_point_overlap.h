// SPDX-License-Identifier: MIT The end-point overlap of a tree: over all boxes but the root's, the area of the
// triangles within that do not lie below it, over the area of all. It is how many boxes a ray enters in vain near where
// it ends, and tells trees of equal surface-area cost apart (Aila, Karras, Laine, "On Quality Metrics of Bounding
// Volume Hierarchies", 2013; all costs are 1).
#ifndef TWINRAY_SHARED_END_POINT_OVERLAP_H
#define TWINRAY_SHARED_END_POINT_OVERLAP_H
#include "shaders/shared/node_boxes.h"

const uint OVERLAP_GROUP = 64u;
const uint OVERLAP_STACK_SIZE = 7u * DEEPEST_RECORDS + 8u; // more than a binary tree needs

struct OverlapSum
{
    float overlap; // area within boxes that are not above it
    float area;
};
BUFFER_OF(OverlapSum, 4);

struct OverlapArgs
{
    REF(SwGeometry) geometry;
    REF(OverlapSum) sums; // one a group
    uint count;           // of leaves in layout bvh2, else of records
    uint reserved;
};

// A triangle cut by boxes: each plane adds a corner at most.
struct Polygon
{
    vec3 corner[9];
    uint count;
};

// What lies at or above a plane across an axis, or with `side` -1 at or below it.
FUNC Polygon cut_by_plane(Polygon whole, uint axis, float plane, float side)
{
    Polygon part;
    part.count = 0u;
    for (uint i = 0u; i < whole.count; i = i + 1u)
    {
        vec3 from = whole.corner[i];
        vec3 to = whole.corner[i + 1u < whole.count ? i + 1u : 0u];
        float above_from = (from[axis] - plane) * side;
        float above_to = (to[axis] - plane) * side;
        if (above_from >= 0.0f)
        {
            part.corner[part.count] = from;
            part.count = part.count + 1u;
        }
        if ((above_from < 0.0f) != (above_to < 0.0f) && part.count < 9u)
        {
            vec3 crossing = from + (to - from) * (above_from / (above_from - above_to));
            crossing[axis] = plane;
            part.corner[part.count] = crossing;
            part.count = part.count + 1u;
        }
    }
    return part;
}

FUNC float area_of_polygon(Polygon polygon, float unit)
{
    vec3 twice = vec3(0.0f);
    for (uint i = 2u; i < polygon.count; i = i + 1u)
    {
        vec3 a = (polygon.corner[i - 1u] - polygon.corner[0]) / unit;
        vec3 b = (polygon.corner[i] - polygon.corner[0]) / unit;
        twice = twice + cross(a, b);
    }
    return 0.5f * length(twice);
}

// The area of the part of a triangle in a box, in squares of `unit`, which keeps it in range.
FUNC float area_within(BvhTriangle triangle, LeafBox box, float unit)
{
    Polygon polygon;
    polygon.corner[0] = triangle.v0;
    polygon.corner[1] = triangle.v1;
    polygon.corner[2] = triangle.v2;
    polygon.count = 3u;
    for (uint axis = 0u; axis < 3u; axis = axis + 1u)
    {
        polygon = cut_by_plane(polygon, axis, box.lo[axis], 1.0f);
        polygon = cut_by_plane(polygon, axis, box.hi[axis], -1.0f);
    }
    return area_of_polygon(polygon, unit);
}

FUNC bool is_apart(LeafBox a, LeafBox b)
{
    return a.lo.x > b.hi.x || a.lo.y > b.hi.y || a.lo.z > b.hi.z || b.lo.x > a.hi.x || b.lo.y > a.hi.y ||
        b.lo.z > a.hi.z;
}

// Of one triangle, whose leaf is `leaf`: child of a node in layout bvh2, else its record. Boxes above the leaf hold all
// of the triangle: they are counted with the others, and taken off once it is known how many they are.
FUNC OverlapSum overlap_of(SwGeometry geometry, BvhTriangle triangle, uint leaf)
{
    OverlapSum sum;
    sum.overlap = 0.0f;
    sum.area = 0.0f;
    LeafBox around = box_of_triangle(triangle);
    float unit = area_unit(geometry.bvh.lo, geometry.bvh.hi);
    if (!is_active(around) || !(unit > 0.0f)) return sum;
    uint stack[OVERLAP_STACK_SIZE];
    uint depths[OVERLAP_STACK_SIZE];
    uint height = 1u;
    stack[0] = geometry.bvh.root;
    depths[0] = 0u;
    uint above = 0u;
    sum.area = area_within(triangle, around, unit);
    while (height > 0u && stack[0] != leaf)
    {
        height = height - 1u;
        uint depth = depths[height] + 1u;
        AnyNode node = node_of(geometry, stack[height]);
        for (uint slot = 0u; slot < slots_of(geometry); slot = slot + 1u)
        {
            if (!has_child(node.places, slot)) continue;
            LeafBox box = box_in(geometry, node, slot);
            if (is_apart(around, box)) continue;
            sum.overlap = sum.overlap + area_within(triangle, box, unit);
            uint child = child_in(geometry, node, slot);
            if (child == leaf) above = depth;
            if (!is_inner_child(geometry, child)) continue;
            stack[height] = child;
            depths[height] = depth;
            height = height + 1u;
        }
    }
    sum.overlap = max(sum.overlap - float(above) * sum.area, 0.0f);
    return sum;
}
#endif
