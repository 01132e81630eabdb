// SPDX-License-Identifier: MIT
// The point of a triangle that is nearest to another point, in float64.
#ifndef TWINRAY_SHARED_POINT_TRIANGLE_H
#define TWINRAY_SHARED_POINT_TRIANGLE_H
#include "shaders/shared/pair_class.h"

struct TrianglePoint
{
    dvec3 offset;   // from the other point
    double squared; // its square
    dvec2 uv;       // barycentric coordinates
};

FUNC double squared_length(dvec3 v) { return dot(v, v); }

// Where a segment is nearest to the origin: from 0, at `from`, to 1. Of one without length, 0.
FUNC double nearest_on_segment(dvec3 from, dvec3 edge)
{
    double squared = squared_length(edge);
    return squared > double(0.0f) ? clamp(-dot(from, edge) / squared, double(0.0f), double(1.0f)) : double(0.0f);
}

FUNC TrianglePoint triangle_point(dvec3 a, dvec3 ab, dvec3 ac, dvec2 uv)
{
    TrianglePoint found;
    found.offset = a + uv.x * ab + uv.y * ac;
    found.squared = squared_length(found.offset);
    found.uv = uv;
    return found;
}

FUNC TrianglePoint nearer_of(TrianglePoint a, TrianglePoint b)
{
    if (b.squared < a.squared) return b;
    return a;
}

// The nearest of the edges' points and, where it lies within, the foot of the perpendicular. Each is a point of the
// triangle to within rounding, whatever its shape, so that a wrong choice, or a normal of which cancellation has left
// little, can never bring the triangle nearer than it is. The distance is off by some 2^-51 of the largest of the triangle's
// sides and the distance.
FUNC TrianglePoint nearest_on_triangle(dvec3 p, Corners64 t)
{
    dvec3 a = t.a - p;
    dvec3 ab = t.b - t.a;
    dvec3 ac = t.c - t.a;
    double on_ab = nearest_on_segment(a, ab);
    double on_ac = nearest_on_segment(a, ac);
    double on_bc = nearest_on_segment(t.b - p, t.c - t.b);
    TrianglePoint best = triangle_point(a, ab, ac, dvec2(on_ab, double(0.0f)));
    best = nearer_of(best, triangle_point(a, ab, ac, dvec2(double(0.0f), on_ac)));
    best = nearer_of(best, triangle_point(a, ab, ac, dvec2(double(1.0f) - on_bc, on_bc)));
    dvec3 normal = cross(ab, ac);
    double squared = squared_length(normal);
    if (!(squared > double(0.0f))) return best;
    double u = dot(cross(ac, a), normal) / squared;
    double v = dot(cross(a, ab), normal) / squared;
    if (!(u > double(0.0f) && v > double(0.0f) && u + v < double(1.0f))) return best;
    return nearer_of(best, triangle_point(a, ab, ac, dvec2(u, v)));
}
#endif
