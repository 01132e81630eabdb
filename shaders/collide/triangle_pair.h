// SPDX-License-Identifier: MIT
// Finds the class of two triangles from nothing but signs of volumes and areas of their vertices. The including file
// declares
//     int volume_sign(dvec3 a, dvec3 b, dvec3 c, dvec3 d)   of det(a - d, b - d, c - d)
//     int area_sign(dvec3 a, dvec3 b, dvec3 c, uint axis)   of det(a - c, b - c) as seen along an axis
// which give -1, 0, 1, or UNKNOWN_SIGN. With signs that are always known the class is exact.
#ifndef TWINRAY_COLLIDE_TRIANGLE_PAIR_H
#define TWINRAY_COLLIDE_TRIANGLE_PAIR_H
#include "shaders/collide/orient.h"
#include "shaders/collide/pair_class.h"

// The shape of a triangle: 2: itself; 1: the segment from a to b = c; 0: the point a = b = c.
struct Hull {
    WorldTriangle at;
    uint dimension;
    uint axis;  // along which it has an area
};

FUNC bool is_known(ivec3 s) { return s.x != UNKNOWN_SIGN && s.y != UNKNOWN_SIGN && s.z != UNKNOWN_SIGN; }
FUNC bool is_all(ivec3 s, int sign) { return s.x == sign && s.y == sign && s.z == sign; }
FUNC bool has_sign(ivec3 s, int sign) { return s.x == sign || s.y == sign || s.z == sign; }
FUNC bool is_on_one_side(ivec3 s) { return is_all(s, 1) || is_all(s, -1); }

FUNC Hull hull_of(WorldTriangle t, INOUT(bool) doubt) {
    Hull hull;
    hull.at = t;
    hull.dimension = 2u;
    bool is_unsure = false;
    for (uint axis = 0u; axis < 3u; axis = axis + 1u) {
        hull.axis = axis;
        int sign = area_sign(t.a, t.b, t.c, axis);
        if (sign == 1 || sign == -1) return hull;
        is_unsure = is_unsure || sign == UNKNOWN_SIGN;
    }
    doubt = doubt || is_unsure;
    dvec3 first = is_before(t.b, t.a) ? t.b : t.a;
    dvec3 last = is_before(t.b, t.a) ? t.a : t.b;
    hull.at.a = is_before(t.c, first) ? t.c : first;
    hull.at.b = is_before(last, t.c) ? t.c : last;
    hull.at.c = hull.at.b;
    hull.dimension = hull.at.a == hull.at.b ? 0u : 1u;
    return hull;
}

FUNC ivec3 sides_of(WorldTriangle plane, WorldTriangle t) {
    return ivec3(volume_sign(plane.a, plane.b, plane.c, t.a), volume_sign(plane.a, plane.b, plane.c, t.b),
                 volume_sign(plane.a, plane.b, plane.c, t.c));
}

// ---- In one plane ---------------------------------------------------------------------------------------------------

// Tells whether the line from p to q has t on one side and the point with the sign `own` not on that side.
struct Separation {
    bool is_strict;  // no point of t on the line
    bool is_weak;
    bool is_known;
};

FUNC Separation separation(dvec3 p, dvec3 q, int own, WorldTriangle t, uint axis) {
    ivec3 s = ivec3(area_sign(p, q, t.a, axis), area_sign(p, q, t.b, axis), area_sign(p, q, t.c, axis));
    Separation found;
    found.is_strict = (is_all(s, 1) && own <= 0) || (is_all(s, -1) && own >= 0);
    found.is_known = is_known(s);
    found.is_weak = found.is_known && ((own < 0 && !has_sign(s, -1)) || (own > 0 && !has_sign(s, 1)));
    return found;
}

FUNC Separation best_of(Separation a, Separation b) {
    Separation both;
    both.is_strict = a.is_strict || b.is_strict;
    both.is_weak = a.is_weak || b.is_weak;
    both.is_known = a.is_known && b.is_known;
    return both;
}

FUNC Separation edges_separation(WorldTriangle of, WorldTriangle t, uint axis) {
    int own = area_sign(of.a, of.b, of.c, axis);
    Separation found = best_of(separation(of.a, of.b, own, t, axis), separation(of.b, of.c, own, t, axis));
    found = best_of(found, separation(of.c, of.a, own, t, axis));
    if (own == UNKNOWN_SIGN) {
        found.is_strict = false;
        found.is_known = false;
    }
    return found;
}

// Convex sets in a plane are apart if a line along an edge of either has them on different sides. Edges of no length
// never do.
FUNC uint coplanar_class(Hull t, Hull u, uint axis) {
    Separation found = best_of(edges_separation(t.at, u.at, axis), edges_separation(u.at, t.at, axis));
    if (found.is_strict) return PAIR_SEPARATE;
    if (!found.is_known) return PAIR_UNDECIDED;
    bool has_area = t.dimension == 2u && u.dimension == 2u && !found.is_weak;
    return has_area ? PAIR_COPLANAR_OVERLAP : PAIR_COPLANAR_TOUCH;
}

// ---- Two triangles that are not in one plane ------------------------------------------------------------------------

// A line through two vertices of a triangle that meets the plane of the other one, upwards.
struct Cut {
    dvec3 from;
    dvec3 to;
    bool is_vertex;  // it meets the plane in one of them
};

// The segment in which a triangle meets the plane of the other: from one cut to the other.
struct Cuts {
    Cut first;
    Cut last;
    bool is_point;   // both are one vertex
    bool straddles;  // there are vertices on both sides
};

FUNC Cut make_cut(dvec3 p, int p_side, dvec3 q, int q_side) {
    Cut cut;
    cut.from = p_side < q_side ? p : q;
    cut.to = p_side < q_side ? q : p;
    cut.is_vertex = p_side == 0 || q_side == 0;
    return cut;
}

FUNC bool is_apex(int own, int b, int c) { return own != b && own != c && !(own == 0 && b != c); }

// `s`: the sides of its vertices, neither all 0 nor on one side.
FUNC Cuts cuts_of(WorldTriangle t, ivec3 s) {
    dvec3 a = t.a;
    dvec3 b = t.b;
    dvec3 c = t.c;
    ivec3 r = s;
    if (is_apex(s.y, s.z, s.x)) {
        a = t.b;
        b = t.c;
        c = t.a;
        r = ivec3(s.y, s.z, s.x);
    } else if (is_apex(s.z, s.x, s.y)) {
        a = t.c;
        b = t.a;
        c = t.b;
        r = ivec3(s.z, s.x, s.y);
    }
    Cuts cuts;
    cuts.first = make_cut(a, r.x, b, r.y);
    cuts.last = make_cut(a, r.x, c, r.z);
    cuts.is_point = r.x == 0;
    cuts.straddles = has_sign(s, 1) && has_sign(s, -1);
    return cuts;
}

// Returns the side of q on which p is, on the line where the planes meet: one sign for all cuts p of one triangle and q
// of the other.
FUNC int order_of(Cut p, Cut q) { return volume_sign(p.from, p.to, q.from, q.to); }

FUNC bool is_touch_of_vertex(int order, Cut p, Cut q) { return order == 0 && (p.is_vertex || q.is_vertex); }

FUNC uint cuts_class(Cuts t, Cuts u) {
    int ff = order_of(t.first, u.first);
    int fl = order_of(t.first, u.last);
    int lf = order_of(t.last, u.first);
    int ll = order_of(t.last, u.last);
    ivec3 some = ivec3(ff, fl, lf);
    if (is_on_one_side(some) && ll == ff) return PAIR_SEPARATE;
    if (!is_known(some) || ll == UNKNOWN_SIGN) return PAIR_UNDECIDED;
    if (t.is_point || u.is_point) return PAIR_VERTEX_TOUCH;
    bool is_length = (has_sign(some, 1) || ll == 1) && (has_sign(some, -1) || ll == -1);
    if (is_length) return t.straddles && u.straddles ? PAIR_CROSSING : PAIR_EDGE_TOUCH;
    bool is_vertex = is_touch_of_vertex(ff, t.first, u.first) || is_touch_of_vertex(fl, t.first, u.last) ||
                     is_touch_of_vertex(lf, t.last, u.first) || is_touch_of_vertex(ll, t.last, u.last);
    return is_vertex ? PAIR_VERTEX_TOUCH : PAIR_EDGE_TOUCH;
}

FUNC uint triangles_class(Hull t, Hull u) {
    ivec3 of_u = sides_of(t.at, u.at);
    if (is_on_one_side(of_u)) return PAIR_SEPARATE;
    ivec3 of_t = sides_of(u.at, t.at);
    if (is_on_one_side(of_t)) return PAIR_SEPARATE;
    if (is_all(of_u, 0) || is_all(of_t, 0)) return coplanar_class(t, u, t.axis);
    if (!is_known(of_u) || !is_known(of_t)) return PAIR_UNDECIDED;
    return cuts_class(cuts_of(t.at, of_t), cuts_of(u.at, of_u));
}

// ---- Segments and points --------------------------------------------------------------------------------------------

FUNC uint segment_triangle_class(Hull segment, Hull t) {
    dvec3 p = segment.at.a;
    dvec3 q = segment.at.b;
    int p_side = volume_sign(t.at.a, t.at.b, t.at.c, p);
    int q_side = volume_sign(t.at.a, t.at.b, t.at.c, q);
    if (p_side == q_side && (p_side == 1 || p_side == -1)) return PAIR_SEPARATE;
    if (p_side == UNKNOWN_SIGN || q_side == UNKNOWN_SIGN) return PAIR_UNDECIDED;
    if (p_side == 0 && q_side == 0) return coplanar_class(segment, t, t.axis);
    ivec3 s =
        ivec3(volume_sign(p, q, t.at.a, t.at.b), volume_sign(p, q, t.at.b, t.at.c), volume_sign(p, q, t.at.c, t.at.a));
    if (has_sign(s, 1) && has_sign(s, -1)) return PAIR_SEPARATE;
    if (!is_known(s)) return PAIR_UNDECIDED;
    if (p_side == 0 || q_side == 0) return PAIR_VERTEX_TOUCH;
    uint zeros = uint(s.x == 0) + uint(s.y == 0) + uint(s.z == 0);
    if (zeros == 0u) return PAIR_CROSSING;
    return zeros == 1u ? PAIR_EDGE_TOUCH : PAIR_VERTEX_TOUCH;
}

FUNC uint point_triangle_class(Hull point, Hull t) {
    int side = volume_sign(t.at.a, t.at.b, t.at.c, point.at.a);
    if (side == UNKNOWN_SIGN) return PAIR_UNDECIDED;
    return side == 0 ? coplanar_class(point, t, t.axis) : PAIR_SEPARATE;
}

// Returns an axis along which three of four points have an area; 3: there is none, they are on one line.
FUNC uint axis_of(dvec3 a, dvec3 b, dvec3 c, dvec3 d, INOUT(bool) doubt) {
    for (uint axis = 0u; axis < 3u; axis = axis + 1u) {
        ivec3 s = ivec3(area_sign(a, b, c, axis), area_sign(a, b, d, axis), area_sign(c, d, a, axis));
        if (has_sign(s, 1) || has_sign(s, -1)) return axis;
        doubt = doubt || !is_known(s);
    }
    return 3u;
}

// Classifies two segments or points.
FUNC uint segments_class(Hull t, Hull u) {
    int side = volume_sign(t.at.a, t.at.b, u.at.a, u.at.b);
    if (side == 1 || side == -1) return PAIR_SEPARATE;
    bool doubt = side == UNKNOWN_SIGN;
    uint axis = axis_of(t.at.a, t.at.b, u.at.a, u.at.b, doubt);
    if (doubt) return PAIR_UNDECIDED;
    if (axis < 3u) return coplanar_class(t, u, axis);
    // For points on a line, that order is the order along it.
    bool is_apart = is_before(t.at.b, u.at.a) || is_before(u.at.b, t.at.a);
    return is_apart ? PAIR_SEPARATE : PAIR_COPLANAR_TOUCH;
}

FUNC uint hulls_class(Hull t, Hull u) {
    if (u.dimension == 2u) return t.dimension == 1u ? segment_triangle_class(t, u) : point_triangle_class(t, u);
    return segments_class(t, u);
}

// ---- Any two triangles ----------------------------------------------------------------------------------------------

FUNC uint class_of(WorldTriangle t, WorldTriangle u) {
    bool doubt = false;
    Hull a = hull_of(t, doubt);
    Hull b = hull_of(u, doubt);
    if (doubt) return PAIR_UNDECIDED;
    if (a.dimension == 2u && b.dimension == 2u) return triangles_class(a, b);
    return a.dimension < b.dimension ? hulls_class(a, b) : hulls_class(b, a);
}
#endif
