// SPDX-License-Identifier: MIT
#ifndef TWINRAY_SHARED_REFINE_GATHER_H
#define TWINRAY_SHARED_REFINE_GATHER_H
#include "shaders/shared/refine.h"

// Where the mesh of a geometry lies, in its block behind what the accelerator keeps there; null: it has no triangles.
struct RefineMesh
{
    Floats positions;
    Uints indices;
};
BUFFER_OF(RefineMesh, 8);
const uint REFINE_MESH_OFFSET = 64u;

struct RefineGatherArgs
{
    REF(InstanceRecord) records;
    REF(RefineInstance) instances;
    uint count;
    uint reserved;
};
#endif
