// SPDX-License-Identifier: MIT
// The arguments of the kernels that prepare the driver's input.
#ifndef TWINRAY_SHARED_HW_BUILD_H
#define TWINRAY_SHARED_HW_BUILD_H
#include "shaders/shared/surface_area.h"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/hw_tlas_header.h"
#include "twinray/glsl/triangle.h"

// Morton codes of the instances' centers, for drivers that build in input order.
struct HwCodesArgs {
    REF(InstanceRecord) records;
    REF(WorldBound) bound;
    Uints keys;
    uint count;
    uint reserved;
};

// The driver's input: the records in their build order, each with the address of its bottom-level structure.
struct HwGatherArgs {
    REF(InstanceRecord) records;
    Uints order;  // absent: the order that `instances` has already
    REF(InstanceRecord) driver_records;
    REF(HwInstance) instances;  // absent: the records keep their order
    uint count;
    uint reserved;
};

// The boxes of instances in the world, in build order.
struct HwAreasArgs {
    REF(InstanceRecord) records;
    REF(HwInstance) instances;  // absent: the records keep their order
    REF(AreaItem) areas;
    uint count;
    uint reserved;
};

// A mesh whose vertices move: three vertices a triangle, in the order in which they are built.
struct HwTrianglesArgs {
    Floats positions;
    Uints indices;
    REF(HwGeometry) geometry;  // its box: written by triangle_bound, read by the others
    REF(WorldBoundBits) bits;
    Uints keys;           // Morton codes, written by triangle_codes
    Uints order;          // position -> triangle of the mesh; absent: the order that `table` has already
    Uints table;          // the same, kept for the trace kernels; absent: the mesh's order
    Floats vertices;      // 9 a triangle, by position
    REF(AreaItem) areas;  // their boxes
    uint count;
    uint group_count;
};
#endif
