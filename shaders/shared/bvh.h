// SPDX-License-Identifier: MIT
// The software accelerator's structures in device memory.
//
//   SwScene -> top-level Bvh over instances -> SwInstance -> bottom-level Bvh over triangles
//
// A reference to a child is the index of an inner node, or LEAF_BIT with the index of a leaf. n leaves have n - 1
// inner nodes; with one leaf the root is that leaf, with none it is NOTHING.
#ifndef TWINRAY_SHARED_BVH_H
#define TWINRAY_SHARED_BVH_H
#include "shaders/shared/instance.h"

const uint LEAF_BIT = 0x80000000u;
const uint NOTHING = 0xffffffffu;

// 64 bytes. Child boxes lie in the parent, so that one fetch decides both. A box is empty where lo > hi.
struct BvhNode
{
    vec3 lo0;
    uint child0;
    vec3 hi0;
    uint child1;
    vec3 lo1;
    uint first; // the leaves below are first..last in sorted order
    vec3 hi1;
    uint last;
};
BUFFER_OF(BvhNode, 16);

// 40 bytes; all corners 0 for a triangle that is not active (see triangle.h), which is never hit. Of a box, v0 and v1 are
// its lowest and highest corner.
struct BvhTriangle
{
    vec3 v0;
    vec3 v1;
    vec3 v2;
    uint primitive_index;
};
BUFFER_OF(BvhTriangle, 8);

struct Bvh
{
    vec3 lo; // around all active leaves; lo > hi: there are none
    vec3 hi;
    REF(BvhNode) nodes;
    uint root;
    uint leaf_count;
};
BUFFER_OF(Bvh, 8);

// What InstanceRecord::geometry points at for the software accelerator. Begins with a GeometryBox.
struct SwGeometry
{
    Bvh bvh;
    REF(BvhTriangle) triangles;
    uint kind; // GEOMETRY_*
    uint reserved;
};
BUFFER_OF(SwGeometry, 8);

// An instance as traversal reads it.
struct SwInstance
{
    vec4 world_to_object[3];
    REF(BvhNode) nodes;
    REF(BvhTriangle) triangles;
    uint root;
    uint custom_index_mask;
    uint flags; // of the instance: INSTANCE_*
    uint kind;  // of its geometry
    float extent; // the largest coordinate of the geometry's box
    uint reserved;
};
BUFFER_OF(SwInstance, 8);

struct SwScene
{
    Bvh bvh;
    REF(SwInstance) instances;
    uint64_t instance_count;
    uint64_t refinement; // address of a RefineScene, or 0
};
BUFFER_OF(SwScene, 8);
#endif
