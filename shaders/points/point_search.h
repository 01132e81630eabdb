// SPDX-License-Identifier: MIT
// Points and the triangles near them, over a tree of boxes (box_tree.h) around triangles in world space.
#ifndef TWINRAY_POINTS_POINT_SEARCH_H
#define TWINRAY_POINTS_POINT_SEARCH_H
#include "shaders/collide/world_vertex.h"

struct SearchPoint {
    dvec3 at;
};
BUFFER_OF(SearchPoint, 8);

const uint NO_ITEM = 0xffffffffu;

struct ClosestItem {
    dvec3 at;  // on the triangle
    double distance;
    dvec2 uv;   // barycentric coordinates: (1 - u - v) a + u b + v c
    uint item;  // NO_ITEM: nothing was found, and all else is undefined
    uint reserved;
};
BUFFER_OF(ClosestItem, 8);

// A point and a triangle that belong together.
struct PointItem {
    uint point;
    uint item;
    double distance;
};
BUFFER_OF(PointItem, 8);

// Each kernel writes one of closest, windings, and found.
struct PointSearchArgs {
    REF(TreeBox) nodes;
    REF(WorldTriangle) triangles;
    REF(TriangleRun) runs;  // by TreeBox::group
    REF(SearchPoint) points;
    REF(TreeBox) boxes;  // of the points, to be sorted
    Uints order;         // of the points, for neighbours to search together
    REF(ClosestItem) closest;
    Uints windings;        // by point: the winding number, without the undecided crossings in `found`
    REF(PointItem) found;  // near triangles, or undecided crossings; with room for `capacity`
    REF(ListTotal) total;  // of found
    double limit;          // of distance; may be infinite
    uint first;            // of this dispatch, in their order
    uint end;
    uint leaf_begin;
    uint leaf_count;
    uint capacity;
    float scale;  // a power of two that makes the whole tree about 1 large
};

// An edge of an open surface, in world space.
struct OpenEdge {
    dvec3 a;
    dvec3 b;
    int passes;  // how much oftener triangles go from a to b than back; in a mirrored instance, from b to a
    uint reserved;
};
BUFFER_OF(OpenEdge, 8);

// A sum of angles without arc tangents: the angle of (x, y), in (-pi, pi], and so many whole revolutions.
struct AngleSum {
    double x;
    double y;
    int revolutions;
    uint is_undecided;  // 1: float64 could not tell on which side of an edge the line passes
};
BUFFER_OF(AngleSum, 8);

struct BoundaryArgs {
    REF(SearchPoint) points;
    REF(OpenEdge) edges;
    REF(AngleSum) angles;  // by point, written
    uint first;            // of the points of this dispatch
    uint end;
    uint edge_count;
};

// The point of a triangle that is closest to another point, in float64.
struct TrianglePoint {
    dvec3 offset;    // from the other point
    double squared;  // its square
    dvec2 uv;        // barycentric coordinates
};

FUNC double squared_length(dvec3 v) { return dot(v, v); }

// Returns the closest point of the segment from `from` to `to`, which is at uv_from and uv_to. From either end, and of
// all triangles that have the edge or the vertex, it is the same bits.
FUNC TrianglePoint closest_on_edge(dvec3 p, dvec3 from, dvec3 to, dvec2 uv_from, dvec2 uv_to) {
    bool is_turned = is_before(to, from);
    dvec3 first = is_turned ? to : from;
    dvec3 last = is_turned ? from : to;
    dvec3 edge = last - first;
    double squared = squared_length(edge);
    double along = double(0.0f);
    if (squared > double(0.0f)) along = clamp(dot(p - first, edge) / squared, double(0.0f), double(1.0f));
    TrianglePoint found;
    found.offset = along == double(1.0f) ? last - p : (first - p) + along * edge;
    found.squared = squared_length(found.offset);
    found.uv = (is_turned ? uv_to : uv_from) * (double(1.0f) - along) + (is_turned ? uv_from : uv_to) * along;
    return found;
}

FUNC TrianglePoint closer_of(TrianglePoint a, TrianglePoint b) {
    if (b.squared < a.squared) return b;
    return a;
}

FUNC bool is_within_triangle(dvec2 uv) {
    return uv.x > double(0.0f) && uv.y > double(0.0f) && uv.x + uv.y < double(1.0f);
}

const uint MOST_CORRECTIONS = 8u;

// Returns the closest of the edges' points and, where it lies within, the foot of the perpendicular. Barycentric
// coordinates of a needle's are off by 2^-53 over its height, for sides of about 1; they are solved for again in what
// is left within the plane, which gains as many digits each time. A foot within that of an edge, or in a triangle so
// thin that nothing is gained, is as near to that edge as float64 can tell. So the distance is off by at most some
// 2^-50 of the largest of the triangle's sides and the distance, whatever its shape.
FUNC TrianglePoint closest_on_triangle(dvec3 p, WorldTriangle t) {
    const double ONE = double(1.0f);
    const double NONE = double(0.0f);
    TrianglePoint best = closest_on_edge(p, t.a, t.b, dvec2(NONE, NONE), dvec2(ONE, NONE));
    best = closer_of(best, closest_on_edge(p, t.b, t.c, dvec2(ONE, NONE), dvec2(NONE, ONE)));
    best = closer_of(best, closest_on_edge(p, t.c, t.a, dvec2(NONE, ONE), dvec2(NONE, NONE)));
    dvec3 ab = t.b - t.a;
    dvec3 ac = t.c - t.a;
    dvec3 normal = cross(ab, ac);
    double squared = squared_length(normal);
    if (!(squared > NONE)) return best;
    TrianglePoint foot;
    foot.offset = t.a - p;
    foot.squared = squared_length(foot.offset) * double(2.0f);  // above any foot
    foot.uv = dvec2(NONE, NONE);
    for (uint i = 0u; i < MOST_CORRECTIONS; i = i + 1u) {
        dvec2 left = dvec2(dot(cross(ac, foot.offset), normal), dot(cross(foot.offset, ab), normal)) / squared;
        TrianglePoint next;
        next.offset = foot.offset + left.x * ab + left.y * ac;
        next.squared = squared_length(next.offset);
        next.uv = foot.uv + left;
        if (!is_within_triangle(next.uv)) return best;
        if (!(next.squared < foot.squared)) break;
        foot = next;
    }
    return closer_of(best, foot);
}

// A point between floats.
struct PointBox {
    vec3 min;
    vec3 max;
};

FUNC PointBox box_around(dvec3 p) {
    PointBox box;
    box.min = floats_below(p);
    box.max = -floats_below(-p);
    return box;
}

// Returns the box in units of 1 / scale, a power of two.
FUNC PointBox scaled(PointBox box, float scale) {
    PRECISE vec3 low = box.min * scale;
    PRECISE vec3 high = box.max * scale;
    box.min = low;
    box.max = high;
    return box;
}

// Returns the box of a point; empty if the point is not finite.
FUNC TreeBox tree_box_of(dvec3 p, uint item) {
    TreeBox box = empty_tree_box();
    if (!is_finite_point(p)) return box;
    box.min = floats_below(p);
    box.max = -floats_below(-p);
    box.item = item;
    return box;
}

// Bounds the squared distance of the box's points from the query, which is scaled, from below, in units of 1 / scale.
// Scaling comes first, so that no difference overflows, and compilers are kept from taking the factor out; flushed
// numbers are too small to count. Each rounding is below 2^-24 of its operand. The largest float stands for all above.
FUNC float squared_distance_below(PointBox p, TreeBox box, float scale) {
    PRECISE vec3 low = box.min * scale;
    PRECISE vec3 high = box.max * scale;
    PRECISE vec3 before = low - p.max;
    PRECISE vec3 behind = p.min - high;
    vec3 gap = max(max(before, behind), vec3(0.0f));
    return min(dot(gap, gap), 3.402823466e38f) * 0.9999995f;
}

// Converts a squared distance in world units to the same form; the result is not below it, nor denormal.
FUNC float squared_distance_above(double squared, float scale) {
    double scaled = squared * double(scale) * double(scale);
    if (!(scaled < double(3.4e38f))) return 3.402823466e38f;
    return float(max(scaled, double(1.17549435082e-38f))) * 1.0000005f;
}
#endif
