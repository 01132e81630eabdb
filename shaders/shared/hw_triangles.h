// SPDX-License-Identifier: MIT
// What the driver is given for a mesh whose vertices move, written by kernels: three corners a triangle, in the order
// in which they are built. Needs hw_scene.h before it.
#ifndef TWINRAY_SHARED_HW_TRIANGLES_H
#define TWINRAY_SHARED_HW_TRIANGLES_H
#include "shaders/shared/triangle.h"

struct HwTrianglesArgs
{
    Floats positions;
    Uints indices;
    REF(HwGeometry) geometry; // its box: written by triangle_bound, read by the others
    REF(WorldBoundBits) bits;
    Uints keys;               // Morton codes, written by triangle_codes
    Uints order;              // place -> triangle of the mesh; null: the order that `table` has already
    Uints table;              // the same, kept for the trace kernels; null: the mesh's order
    Floats corners;           // 9 a triangle, by place
    REF(AreaItem) areas;      // their boxes
    uint count;
    uint group_count;
};
#endif
