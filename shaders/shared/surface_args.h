// SPDX-License-Identifier: MIT
// Arguments of kernels that find the surfaces of hits for the host.
#ifndef TWINRAY_SHARED_SURFACE_ARGS_H
#define TWINRAY_SHARED_SURFACE_ARGS_H
#include "twinray/glsl/surface_at.h"

struct SurfaceArgs {
    REF(SurfaceTable) table;
    REF(Ray) rays;
    REF(Hit) hits;
    Address results;  // by hit: a Surface, or the four components of the attribute
    uint count;
    uint reserved;
};

struct InterpolateArgs {
    SurfaceArgs of;
    vec4 missing;  // of misses and of meshes that do not have it
    uint number;
    uint reserved;
};
#endif
