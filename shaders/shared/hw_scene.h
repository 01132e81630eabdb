// SPDX-License-Identifier: MIT
// What the hardware accelerator leaves on the device and what its trace kernels take. Needs ray.h before it.
#ifndef TWINRAY_SHARED_HW_SCENE_H
#define TWINRAY_SHARED_HW_SCENE_H

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

// Both trace paths take it as push constants.
struct HwTraceArgs
{
    REF(HwScene) scene;
    REF(Ray) rays;
    REF(Hit) hits;
    uint count;
    uint mask;  // low 8 bits: sees the instances that share a bit
};

// Ids of the specialisation constants of the trace kernels.
const uint HW_HAS_REMAP = 0u;  // triangles and instances were reordered before the build: map the ids back
const uint HW_IS_ANY = 1u;     // stop at the first hit found
#endif
