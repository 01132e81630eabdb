// SPDX-License-Identifier: MIT
// The point of a triangle that is closest to another point, in float64.
#ifndef TWINRAY_POINTS_POINT_TRIANGLE_H
#define TWINRAY_POINTS_POINT_TRIANGLE_H
#include "shaders/collide/pair_class.h"

struct TrianglePoint
{
    dvec3 offset;   // from the other point
    double squared; // its square
    dvec2 uv;       // barycentric coordinates
};

FUNC double squared_length(dvec3 v) { return dot(v, v); }

FUNC bool comes_first(dvec3 p, dvec3 q)
{
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    return p.z < q.z;
}

// The closest point of the segment from `from` to `to`, which is at uv_from and uv_to. From either end, and of all
// triangles that have the edge or the vertex, it is the same bits.
FUNC TrianglePoint closest_on_edge(dvec3 p, dvec3 from, dvec3 to, dvec2 uv_from, dvec2 uv_to)
{
    bool is_turned = comes_first(to, from);
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

FUNC TrianglePoint closer_of(TrianglePoint a, TrianglePoint b)
{
    if (b.squared < a.squared) return b;
    return a;
}

FUNC bool is_within_triangle(dvec2 uv)
{
    return uv.x > double(0.0f) && uv.y > double(0.0f) && uv.x + uv.y < double(1.0f);
}

const uint MOST_CORRECTIONS = 8u;

// The closest of the edges' points and, where it lies within, the foot of the perpendicular. Barycentric coordinates of
// a needle's are off by 2^-53 over its height, for sides of about 1; they are solved for again in what is left within
// the plane, which gains as many digits each time. A foot within that of an edge, or in a triangle so thin that nothing
// is gained, is as near to that edge as float64 can tell. So the distance is off by at most some 2^-50 of the largest
// of the triangle's sides and the distance, whatever its shape.
FUNC TrianglePoint closest_on_triangle(dvec3 p, WorldTriangle t)
{
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
    foot.squared = squared_length(foot.offset) * double(2.0f); // above any foot
    foot.uv = dvec2(NONE, NONE);
    for (uint i = 0u; i < MOST_CORRECTIONS; i = i + 1u)
    {
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
#endif
