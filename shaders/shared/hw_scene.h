// SPDX-License-Identifier: MIT
// What the hardware accelerator leaves on the device and what its trace kernels take. Needs ray.h, world_bound.h and
// surface_area.h before it.
#ifndef TWINRAY_SHARED_HW_SCENE_H
#define TWINRAY_SHARED_HW_SCENE_H

// What InstanceRecord::geometry points at for the hardware accelerator. Begins with a GeometryBox.
struct HwGeometry
{
    vec3 lo;
    vec3 hi;
    uint64_t blas;    // device address of the bottom-level structure; 0: nothing can be hit
    Uints triangles;  // triangle of the built geometry -> triangle of the mesh; null: the same
};
BUFFER_OF(HwGeometry, 8);

// Leads from one instance as the driver numbers it back to the user's numbering.
struct HwInstance
{
    Uints triangles;      // triangle of the built geometry -> triangle of the mesh
    uint instance_index;  // position in the accelerator's instance array
    uint pad;
};
BUFFER_OF(HwInstance, 8);

struct HwScene
{
    uint64_t tlas;              // device address of the top-level acceleration structure
    REF(HwInstance) instances;  // by InstanceId; null without HAS_REMAP
};
BUFFER_OF(HwScene, 8);

// Morton codes of the instances' centers, for drivers that build in input order.
struct HwCodesArgs
{
    REF(InstanceRecord) records;
    REF(WorldBound) bound;
    Uints keys;
    Uints order;
    uint count;
    uint reserved;
};

// What the driver builds from: the records in their build order, each with the address of its bottom-level structure.
struct HwGatherArgs
{
    REF(InstanceRecord) records;
    Uints order;                // null: the order that `instances` has already
    REF(InstanceRecord) driver_records;
    REF(HwInstance) instances;  // null: the records keep their order
    REF(AreaItem) areas;        // the boxes in the world, in build order
    uint count;
    uint reserved;
};

// Both trace paths take it as push constants.
struct HwTraceArgs
{
    REF(HwScene) scene;
    REF(Ray) rays;
    REF(Hit) hits;
    Uints indirect_count; // null, or where a smaller count may stand
    uint count; // where it ends
    uint mask;  // low 8 bits: sees the instances that share a bit
    uint flags;
    uint first; // ray that the launch begins with
};

// Ids of the specialisation constants of the trace kernels.
const uint HW_HAS_REMAP = 0u;  // triangles and instances were reordered before the build: map the ids back
const uint HW_IS_ANY = 1u;     // stop at the first hit found
#endif
