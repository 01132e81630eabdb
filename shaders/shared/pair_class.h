// SPDX-License-Identifier: MIT How two triangles lie to each other, as sets of points: closed, and a triangle without
// area is the segment or the point that it covers. The class does not depend on the order of the triangles or of their
// corners.
#ifndef TWINRAY_SHARED_PAIR_CLASS_H
#define TWINRAY_SHARED_PAIR_CLASS_H
#include "shaders/shared/box_tree.h"

const uint PAIR_SEPARATE = 0u;         // no common point
// Not all six corners in one plane:
const uint PAIR_VERTEX_TOUCH = 1u;     // one common point, an end or corner of at least one, and not inside of both
const uint PAIR_EDGE_TOUCH = 2u;       // more than that, but the insides have no common point
const uint PAIR_CROSSING = 5u;         // the insides (without corners and edges; of a segment, without its ends) meet
// All six in one plane:
const uint PAIR_COPLANAR_TOUCH = 3u;   // common points, but no common area
const uint PAIR_COPLANAR_OVERLAP = 4u; // a common area
const uint PAIR_CLASSES = 6u;
const uint PAIR_UNDECIDED = 6u;        // float64 cannot tell

struct Corners64
{
    dvec3 a;
    dvec3 b;
    dvec3 c;
};
BUFFER_OF(Corners64, 8);

// A mesh where an instance puts it, and which of all triangles are its.
struct PlacedMesh
{
    vec4 object_to_world[3];
    Floats positions;
    Uints indices;
    Uints vertex_ids;    // of each vertex: those with one id are one; null: each is its own
    uint first_triangle; // ascending from one placed mesh to the next
    uint is_mirrored;    // 1 where the map turns triangles round
};
BUFFER_OF(PlacedMesh, 8);

struct TriangleName
{
    uvec3 corners; // ids of vertices
    uint placed;   // index of its placed mesh
};
BUFFER_OF(TriangleName, 16);

struct WorldTrianglesArgs
{
    REF(PlacedMesh) meshes;
    REF(TreeBox) boxes;      // written, as the next two
    REF(Corners64) corners;
    REF(TriangleName) names;
    uint mesh_count;
    uint count;
};

struct PairContact
{
    uint first;
    uint second;
    uint class_of_pair;
    uint reserved;
};
BUFFER_OF(PairContact, 16);

struct ClassifyArgs
{
    REF(Corners64) corners;
    REF(TriangleName) names;
    Uints first;
    Uints second;
    REF(PairContact) contacts; // written: all pairs that are not separate, with room for `count`
    REF(ListTotal) total;
    uint count;
    uint reserved;
};
#endif
