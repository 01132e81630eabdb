// SPDX-License-Identifier: MIT
// The class of two triangles of meshes; those of one mesh may be neighbours. It also needs the declarations that
// includers of triangle_pair.h make.
#ifndef TWINRAY_COLLIDE_NEIGHBOURS_H
#define TWINRAY_COLLIDE_NEIGHBOURS_H
#include "shaders/collide/triangle_pair.h"

FUNC uint count_among(uvec3 t, uvec3 u) {
    return uint(t.x == u.x || t.x == u.y || t.x == u.z) + uint(t.y == u.x || t.y == u.y || t.y == u.z) +
           uint(t.z == u.x || t.z == u.y || t.z == u.z);
}
// Returns the lower of both: a triangle without area may name a vertex twice.
FUNC uint count_shared(uvec3 t, uvec3 u) { return min(count_among(t, u), count_among(u, t)); }

// Returns whether p and q are in one direction from v; if in doubt, true.
FUNC bool is_same_way(dvec3 v, dvec3 p, dvec3 q, INOUT(bool) doubt) {
    if (v == p || v == q || is_before(v, p) != is_before(v, q)) return false;
    bool is_unsure = false;
    for (uint axis = 0u; axis < 3u; axis = axis + 1u) {
        int sign = area_sign(v, p, q, axis);
        if (sign == 1 || sign == -1) return false;
        is_unsure = is_unsure || sign == UNKNOWN_SIGN;
    }
    doubt = doubt || is_unsure;
    return true;
}

// Turns the triangle so that the vertex with the given ids comes first.
FUNC WorldTriangle from_vertex(WorldTriangle t, uvec3 ids, uvec3 others) {
    WorldTriangle turned = t;
    if (ids.y == others.x || ids.y == others.y || ids.y == others.z) {
        turned.a = t.b;
        turned.b = t.c;
        turned.c = t.a;
    }
    if (ids.z == others.x || ids.z == others.y || ids.z == others.z) {
        turned.a = t.c;
        turned.b = t.a;
        turned.c = t.b;
    }
    return turned;
}

// Returns the class of neighbours: PAIR_SEPARATE if they have only their shared vertices and the edge between two of
// them in common.
FUNC uint class_of_neighbours(WorldTriangle t, uvec3 t_ids, WorldTriangle u, uvec3 u_ids) {
    uint found = class_of(t, u);
    if (found == PAIR_SEPARATE || found == PAIR_COPLANAR_OVERLAP || found == PAIR_UNDECIDED) return found;
    if (count_shared(t_ids, u_ids) > 1u || found == PAIR_VERTEX_TOUCH) return PAIR_SEPARATE;
    if (found != PAIR_COPLANAR_TOUCH) return found;
    // They share a line only along edges that leave their vertex in one direction.
    WorldTriangle a = from_vertex(t, t_ids, u_ids);
    WorldTriangle b = from_vertex(u, u_ids, t_ids);
    bool doubt = false;
    bool is_more = is_same_way(a.a, a.b, b.b, doubt) || is_same_way(a.a, a.b, b.c, doubt) ||
                   is_same_way(a.a, a.c, b.b, doubt) || is_same_way(a.a, a.c, b.c, doubt);
    if (!is_more) return PAIR_SEPARATE;
    return doubt ? PAIR_UNDECIDED : PAIR_COPLANAR_TOUCH;
}

FUNC uint class_of_pair(WorldTriangle t, TriangleName t_name, WorldTriangle u, TriangleName u_name) {
    if (t_name.run != u_name.run || count_shared(t_name.vertices, u_name.vertices) == 0u) return class_of(t, u);
    return class_of_neighbours(t, t_name.vertices, u, u_name.vertices);
}
#endif
