// SPDX-License-Identifier: MIT
// The part that the boundary of an open surface adds to the crossings of point_winding.h for the generalized winding
// number (Jacobson, Kavan, Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding Numbers",
// 2013). Swept along -x to infinity, the boundary closes the surface, and the line of the crossings, along +x, never
// meets the swept area: so they are the winding number of the two together, and the solid angle of each edge's area, a
// spherical triangle with a corner at -x, is taken off again (the idea: Martens, Trettner, Bessmeltsev, "The Antipodal
// Method", 2026). The including file declares area_sign: see triangle_pair.h.
#ifndef TWINRAY_POINTS_POINT_BOUNDARY_H
#define TWINRAY_POINTS_POINT_BOUNDARY_H
#include "shaders/points/point_search.h"
#include "shaders/points/point_winding.h"

FUNC AngleSum no_angle() {
    AngleSum none;
    none.x = double(1.0f);
    none.y = double(0.0f);
    none.revolutions = 0;
    none.is_undecided = 0u;
    return none;
}

// Adds the angle of (x, y), which is not (0, 0); of (x, 0) with x < 0, half a turn, back if `is_back`.
FUNC AngleSum with_angle(AngleSum sum, double x, double y, bool is_back) {
    if (is_back && y == double(0.0f) && x < double(0.0f)) sum.revolutions -= 1;
    double real = sum.x * x - sum.y * y;
    double imaginary = sum.x * y + sum.y * x;
    double size = sqrt(real * real + imaginary * imaginary);
    bool is_up = sum.y >= double(0.0f);
    bool is_whole = is_up && x < double(0.0f) && imaginary == double(0.0f) && real > double(0.0f);  // of two halves
    bool is_sum_up = imaginary >= double(0.0f) && !is_whole;
    if (is_up == (y >= double(0.0f)) && is_up != is_sum_up) sum.revolutions += is_up ? 1 : -1;
    sum.x = real / size;
    sum.y = imaginary / size;
    return sum;
}

// Returns (1 - x, y, z) of a unit vector without cancellation; of +x, as the line is moved, along -y, in units of the
// line's move.
FUNC dvec3 beside_line(dvec3 unit) {
    double y2z2 = unit.y * unit.y + unit.z * unit.z;
    if (unit.x <= double(0.0f)) return dvec3(double(1.0f) - unit.x, unit.y, unit.z);
    if (y2z2 == double(0.0f)) return dvec3(double(0.0f), -double(1.0f), double(0.0f));
    return dvec3(y2z2 / (double(1.0f) + unit.x), unit.y, unit.z);
}

// Adds half of the solid angle, seen from the point, of the area that the edge sweeps (van Oosterom and Strackee 1983).
// Adds nothing for a point on the edge, whose winding number is either side's.
FUNC AngleSum with_edge(AngleSum sum, dvec3 point, OpenEdge edge) {
    dvec3 a = edge.a - point;
    dvec3 b = edge.b - point;
    double length_a = sqrt(dot(a, a));
    double length_b = sqrt(dot(b, b));
    int side = moved_side(edge.a, edge.b, point);  // exact: it decides to which side half a sphere counts
    if (length_a == double(0.0f) || length_b == double(0.0f) || side == 0) return sum;
    a = beside_line(a / length_a);
    b = beside_line(b / length_b);
    double x = dot(a, b);
    double y = a.z * b.y - a.y * b.z;
    if (side == UNKNOWN_SIGN && x <= double(0.0f)) sum.is_undecided = 1u;
    if (x == double(0.0f) && y == double(0.0f)) return sum;
    bool is_back = side == UNKNOWN_SIGN ? y < double(0.0f) : side > 0;
    if (edge.passes < 0) is_back = !is_back;
    y = is_back ? -abs(y) : abs(y);
    int times = edge.passes < 0 ? -edge.passes : edge.passes;
    for (int i = 0; i < times; ++i) sum = with_angle(sum, x, y, is_back);
    return sum;
}
#endif
