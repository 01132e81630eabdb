// SPDX-License-Identifier: MIT
// Points and the triangles near them, over a tree of boxes (box_tree.h) around triangles in world space.
#ifndef TWINRAY_POINTS_POINT_SEARCH_H
#define TWINRAY_POINTS_POINT_SEARCH_H
#include "shaders/points/point_triangle.h"
#include "shaders/collide/world_vertex.h"

struct SearchPoint
{
    dvec3 at;
};
BUFFER_OF(SearchPoint, 8);

const uint NO_ITEM = 0xffffffffu;

struct ClosestItem
{
    dvec3 at;        // on the triangle
    double distance;
    dvec2 uv;        // barycentric coordinates: (1 - u - v) a + u b + v c
    uint item;       // NO_ITEM: there is none, and all else is undefined
    uint reserved;
};
BUFFER_OF(ClosestItem, 8);

// A point and a triangle that belong together.
struct PointItem
{
    uint point;
    uint item;
    double distance;
};
BUFFER_OF(PointItem, 8);

// Each kernel writes one of closest, windings, and found.
struct PointSearchArgs
{
    REF(TreeBox) nodes;
    REF(WorldTriangle) triangles;
    REF(InstancedMesh) meshes;   // by TreeBox::group
    REF(SearchPoint) points;
    REF(TreeBox) boxes;       // of the points, to be sorted
    Uints order;              // of the points, for neighbours to search together
    REF(ClosestItem) closest;
    Uints windings;           // by point: the winding number, without what `found` says is undecided
    REF(PointItem) found;     // near triangles, or undecided crossings; with room for `capacity`
    REF(ListTotal) total;     // of found
    double limit;             // of distance; may be infinite
    uint first;               // of this dispatch, in their order
    uint end;
    uint leaf_begin;
    uint leaf_count;
    uint capacity;
    float scale;              // a power of two that makes the whole tree about 1 large
};

// An edge of an open surface, in world space.
struct OpenEdge
{
    dvec3 a;
    dvec3 b;
    int passes; // how much oftener triangles go from a to b than back; of a mirrored instance the other way round
    uint reserved;
};
BUFFER_OF(OpenEdge, 8);

// A sum of angles without arc tangents: the angle of (x, y), in (-pi, pi], and so many whole revolutions.
struct AngleSum
{
    double x;
    double y;
    int revolutions;
    uint is_undecided; // 1: float64 could not tell on which side of an edge the line passes
};
BUFFER_OF(AngleSum, 8);

struct BoundaryArgs
{
    REF(SearchPoint) points;
    REF(OpenEdge) edges;
    REF(AngleSum) angles; // by point, written
    uint first;           // of the points of this dispatch
    uint end;
    uint edge_count;
};

// A point between floats.
struct PointBox
{
    vec3 min;
    vec3 max;
};

FUNC PointBox box_around(dvec3 p)
{
    PointBox box;
    box.min = floats_below(p);
    box.max = -floats_below(-p);
    return box;
}

// In units of 1 / scale, a power of two.
FUNC PointBox scaled(PointBox box, float scale)
{
    PRECISE vec3 low = box.min * scale;
    PRECISE vec3 high = box.max * scale;
    box.min = low;
    box.max = high;
    return box;
}

// Empty for a point that is not finite.
FUNC TreeBox tree_box_of(dvec3 p, uint item)
{
    TreeBox box = empty_tree_box();
    if (!is_finite_point(p)) return box;
    box.min = floats_below(p);
    box.max = -floats_below(-p);
    box.item = item;
    return box;
}

// Not above the squared distance of any point of the box from the query, which is scaled, in units of 1 / scale.
// Scaling comes first, so that no difference overflows, and compilers are kept from taking the factor out; what it
// flushes is below what counts. Each rounding is below 2^-24 of what it rounds. The largest float stands for all above.
FUNC float squared_distance_below(PointBox p, TreeBox box, float scale)
{
    PRECISE vec3 low = box.min * scale;
    PRECISE vec3 high = box.max * scale;
    PRECISE vec3 before = low - p.max;
    PRECISE vec3 behind = p.min - high;
    vec3 gap = max(max(before, behind), vec3(0.0f));
    return min(dot(gap, gap), 3.402823466e38f) * 0.9999995f;
}

// The same of a squared distance in world units, but not below it, nor denormal.
FUNC float squared_distance_above(double squared, float scale)
{
    double scaled = squared * double(scale) * double(scale);
    if (!(scaled < double(3.4e38f))) return 3.402823466e38f;
    return float(max(scaled, double(1.17549435082e-38f))) * 1.0000005f;
}
#endif
