// SPDX-License-Identifier: MIT
// The options of a trace, and the arguments of a kernel that traces a batch: the same for both accelerators.
#ifndef TWINRAY_SHARED_TRACE_H
#define TWINRAY_SHARED_TRACE_H
#include "shaders/shared/features.h"
#include "twinray/glsl/program.h"
#include "shaders/shared/workgroup.h"
#ifdef TWINRAY_REFINED
#include "shaders/shared/refine_scene.h"
#endif

// Every instance is treated as non-opaque, in kernels that have FEATURE_FILTERS. The value is that of SPIR-V's ray flag
// NoOpaque.
const uint ALL_NON_OPAQUE = 2u;

struct TraceOptions {
    uint mask;   // sees the instances that share a bit of its low 8
    uint flags;  // CULL_BACK, CULL_FRONT, ALL_NON_OPAQUE
    // The rest is constant in a kernel, so that it is compiled for it.
    uint query;     // QUERY_*
    uint level;     // LEVEL_*
    uint features;  // FEATURE_*
    Address user_data;
#ifdef TWINRAY_REFINED
    // The given ray, at LEVEL_REFINED and above; the traced one begins `advance` ahead of it.
    Ray given;
    double advance;
    REF(RefineInstance) instances;
#endif
};

// Returns t of the given ray for t of the traced ray.
FUNC float t_of_given(float t, TraceOptions options) {
#ifdef TWINRAY_REFINED
    if (options.level >= LEVEL_REFINED) return float(double(t) + options.advance);
#endif
    return t;
}

struct TraceArgs {
    Address scene;  // AccelView::scene
    REF(Ray) rays;
    REF(Hit) hits;
    Uints indirect_count;  // absent, or the address of a count that may be smaller
    Address user_data;
    Uints order;  // absent, or the ray that each invocation traces
    uint count;   // the end of the rays of this launch
    uint mask;
    uint flags;
    uint first;  // ray that the launch begins with
};

FUNC uint ray_at(Uints order, uint position) { return is_absent(order) ? position : AT(order, position); }
#endif
