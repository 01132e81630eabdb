// SPDX-License-Identifier: MIT
// What levels from refined on know of a scene: meshes and transforms as they were given.
#ifndef TWINRAY_SHARED_REFINE_SCENE_H
#define TWINRAY_SHARED_REFINE_SCENE_H
#include "shaders/shared/transform_double.h"
#include "shaders/shared/world_bound.h"

// An instance of what was built: positions in units of a power of two, which the map contains.
struct RefineInstance
{
    vec4 object_to_world[3];
    Floats positions; // of the mesh, 3 floats a vertex
    Uints indices;    // 3 a triangle, in the user's numbering; null: boxes
    RowsDouble world_to_object;
    float residual;   // the relative error of vectors that it maps, at most
    float extent;     // the largest coordinate of the geometry's box
    uint is_mirrored; // 1 where the map's determinant is negative
    uint reserved;
};
BUFFER_OF(RefineInstance, 16);

struct RefineScene
{
    REF(WorldBound) bound;
    REF(RefineInstance) instances; // in the order of Hit::instance_index
};
BUFFER_OF(RefineScene, 8);

struct RefineGatherArgs
{
    REF(InstanceRecord) records;
    REF(RefineInstance) instances;
    uint count;
    uint reserved;
};
#endif
