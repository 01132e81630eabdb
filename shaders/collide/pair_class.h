// SPDX-License-Identifier: MIT
// The relation of two triangles as sets of points: closed, and a triangle without area is the segment or the point that
// it covers. The class does not depend on the order of the triangles or of their vertices. The including file declares
// WorldTriangle: world_triangle.glsl, in C++ <twinray/queries.h>.
#ifndef TWINRAY_COLLIDE_PAIR_CLASS_H
#define TWINRAY_COLLIDE_PAIR_CLASS_H
#include "shaders/collide/box_tree.h"

const uint PAIR_SEPARATE = 0u;  // no common point
// Not all six vertices in one plane:
const uint PAIR_VERTEX_TOUCH = 1u;  // one common point, an end or vertex of at least one, and not inside of both
const uint PAIR_EDGE_TOUCH = 2u;    // more than that, but the insides have no common point
const uint PAIR_CROSSING = 5u;      // the insides (without vertices and edges; of a segment, without its ends) meet
// All six in one plane:
const uint PAIR_COPLANAR_TOUCH = 3u;    // common points, but no common area
const uint PAIR_COPLANAR_OVERLAP = 4u;  // a common area
const uint PAIR_CLASSES = 6u;
const uint PAIR_UNDECIDED = 6u;  // float64 cannot tell

BUFFER_OF(WorldTriangle, 8);

// A mesh as an instance places it, and the range of its triangles.
struct TriangleRun {
    InstancedMesh placed;  // positions in units of `scale`
    Uints vertex_ids;      // of each vertex: those with one id are one; absent: each is its own
    uint first_triangle;   // ascending from one run to the next
    uint is_mirrored;      // 1 where the map turns triangles round
    float scale;           // a power of two
    uint reserved;
};
BUFFER_OF(TriangleRun, 8);

struct TriangleName {
    uvec3 vertices;  // their ids
    uint run;        // index of its run
};
BUFFER_OF(TriangleName, 16);

struct WorldTrianglesArgs {
    REF(TriangleRun) runs;
    REF(TreeBox) boxes;  // written, as the next two
    REF(WorldTriangle) triangles;
    REF(TriangleName) names;
    uint run_count;
    uint count;
};

struct PairContact {
    uint first;
    uint second;
    uint class_of_pair;
    uint reserved;
};
BUFFER_OF(PairContact, 16);

struct ClassifyArgs {
    REF(WorldTriangle) triangles;
    REF(TriangleName) names;
    Uints first;
    Uints second;
    REF(PairContact) contacts;  // written: all pairs that are not separate, with room for `count`
    REF(ListTotal) total;
    uint count;
    uint reserved;
};

// Orders points, so that results do not depend on the order of vertices.
FUNC bool is_before(dvec3 p, dvec3 q) {
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    return p.z < q.z;
}
#endif
