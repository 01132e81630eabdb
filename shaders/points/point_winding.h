// SPDX-License-Identifier: MIT
// Counts how a closed surface winds around a point: the signed number of triangles that the line from the point along
// +x crosses; those whose front is met last count up. The line is moved infinitesimally, by e in y and e^2 in z, so
// that it meets no edge and no vertex ("Simulation of Simplicity", Edelsbrunner and Muecke 1990): nothing is counted
// twice or lost. The including file declares volume_sign and area_sign: see triangle_pair.h.
#ifndef TWINRAY_POINTS_POINT_WINDING_H
#define TWINRAY_POINTS_POINT_WINDING_H
#include "shaders/collide/orient.h"
#include "shaders/collide/pair_class.h"

// Returns on which side of the edge from a to b, seen against +x, the moved line passes: 1: left. 0: the edge is seen
// as a point.
FUNC int moved_side(dvec3 a, dvec3 b, dvec3 p) {
    int side = area_sign(a, b, p, 0u);
    if (side != 0) return side;
    if (a.z != b.z) return a.z > b.z ? 1 : -1;
    if (a.y != b.y) return b.y > a.y ? 1 : -1;
    return 0;
}

// Returns 1 or -1 if the moved line crosses the triangle, else 0, or UNKNOWN_SIGN. 0 for a point on the triangle.
FUNC int crossing_of(dvec3 p, WorldTriangle t) {
    int ab = moved_side(t.a, t.b, p);
    int bc = moved_side(t.b, t.c, p);
    int ca = moved_side(t.c, t.a, p);
    bool is_left = ab == 1 || bc == 1 || ca == 1;
    bool is_right = ab == -1 || bc == -1 || ca == -1;
    if ((is_left && is_right) || ab == 0 || bc == 0 || ca == 0) return 0;
    int ahead = volume_sign(t.a, t.b, t.c, p);
    if (ahead == 0) return 0;
    if (ab == UNKNOWN_SIGN || bc == UNKNOWN_SIGN || ca == UNKNOWN_SIGN || ahead == UNKNOWN_SIGN) return UNKNOWN_SIGN;
    return ahead == ab ? ab : 0;
}
#endif
