// SPDX-License-Identifier: MIT
// The hardware accelerator's structs on the device. Needs ray.h and world_bound.h before it.
#ifndef TWINRAY_SHARED_HW_TLAS_HEADER_H
#define TWINRAY_SHARED_HW_TLAS_HEADER_H
#include "twinray/glsl/accel_header.h"

// The target of InstanceRecord::geometry for the hardware accelerator. Begins with a GeometryBox.
struct HwGeometry {
    vec3 lo;
    vec3 hi;
    Address blas;     // device address of the bottom-level structure; 0: nothing can be hit
    Uints triangles;  // primitive of the built geometry -> the user's; absent: the same
    uint kind;        // GEOMETRY_*
    uint reserved;
};
BUFFER_OF(HwGeometry, 8);

// Maps one instance in the driver's numbering back to the user's numbering.
struct HwInstance {
    Uints triangles;      // primitive of the built geometry -> the user's
    uint instance_index;  // position in the accelerator's instance array
    uint pad;
};
BUFFER_OF(HwInstance, 8);

struct HwTlasHeader {
    AccelHeader accel;
    Address tlas;               // device address of the top-level acceleration structure
    REF(HwInstance) instances;  // by InstanceId; absent without FEATURE_REMAP
};
BUFFER_OF(HwTlasHeader, 8);
#endif
