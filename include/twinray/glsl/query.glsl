// SPDX-License-Identifier: MIT
// Ray queries inside kernels, on either accelerator. Compile the kernel once with TWINRAY_SW and once with TWINRAY_HW
// defined (twinray_add_kernel does both), and dispatch the one that fits the accelerator. HW needs VK_KHR_ray_query.
//
//     layout(push_constant, scalar) uniform Push { Address accel; ... };   // AccelView::scene
//     Hit hit;
//     if (closest_hit(accel, ray, hit)) ...
//     if (any_hit(accel, ray)) ...
//
// Levels from refined on need TWINRAY_REFINED defined (twinray_add_kernel(... REFINED)) and a device with float64.
//
// Specialise FEATURES_CONSTANT with AccelView::features, or AbstractAccel::features_for, to leave out code that the
// scene does not need, and LEVEL_CONSTANT with the level. With TWINRAY_PROGRAM defined, the kernel defines
// intersect_primitive and accept_hit itself (see twinray/glsl/program.h), before or after this include.
#ifndef TWINRAY_QUERY_GLSL
#define TWINRAY_QUERY_GLSL
#include "twinray/glsl/common.glsl"
#include "shaders/shared/trace.h"

layout(constant_id = FEATURES_CONSTANT) const uint TRACE_FEATURES = FEATURES_ALL;
layout(constant_id = LEVEL_CONSTANT) const uint TRACE_LEVEL = LEVEL_WATERTIGHT;

#if defined(TWINRAY_SW)
#include "twinray/glsl/stack.glsl"
#include "shaders/shared/traverse.h"
// Returns the hit by float32 only, whatever options.level: trace() starts with it. A miss has hit = 0.
Hit trace_float32(Address accel, Ray ray, TraceOptions options) {
    return traverse(AT(REF(SwTlasHeader)(accel), 0), ray, options);
}
#elif defined(TWINRAY_HW)
#extension GL_EXT_ray_query : require
#include "shaders/hwtlas/ray_query.glsl"
#else
#error "twinray/glsl/query.glsl: define TWINRAY_SW or TWINRAY_HW"
#endif

#ifdef TWINRAY_REFINED
#include "shaders/shared/refine.h"
Hit trace(Address accel, Ray ray, TraceOptions options) {
    if (options.level < LEVEL_REFINED) return trace_float32(accel, ray, options);
    RefineScene scene = AT(REF(RefineScene)(AT(REF(AccelHeader)(accel), 0).refinement), 0);
    WorldBound bound = AT(scene.bound, 0);
    options.given = ray;
    options.instances = scene.instances;
    Ray near = searched_ray(bound.lo, bound.hi, options);
    Hit hit;
    float step = REFINING_STEP;
    do hit = trace_float32(accel, near, options);
    while (hit.hit != 0u && !refine(hit, near, step, options));
    return hit;
}
#else
// Returns the hit for `options`, by their level; t is in units of the direction. A miss has hit = 0.
Hit trace(Address accel, Ray ray, TraceOptions options) { return trace_float32(accel, ray, options); }
#endif

// Returns options with this kernel's level and features. mask: 8 bits; flags: CULL_BACK, CULL_FRONT or 0; query:
// QUERY_CLOSEST or QUERY_ANY.
TraceOptions trace_options(uint mask, uint flags, uint query, Address user_data) {
    TraceOptions options;
    options.user_data = user_data;
    options.mask = mask;
    options.flags = flags;
    options.query = query;
    options.level = TRACE_LEVEL;
    options.features = TRACE_FEATURES;
    return options;
}

// Returns whether there is a hit; shared by closest_hit() and any_hit().
bool find_hit(Address accel, Ray ray, TraceOptions options, out Hit hit) {
    hit = trace(accel, ray, options);
    return hit.hit != 0u;
}

// Finds the closest hit of the instances that share a bit with mask; flags: CULL_BACK, CULL_FRONT or 0. Returns false
// if there is none; hit is then a miss. user_data is for kernels with a program of their own (twinray/glsl/program.h),
// which gets it in its candidates.
bool closest_hit(Address accel, Ray ray, uint mask, uint flags, Address user_data, out Hit hit) {
    return find_hit(accel, ray, trace_options(mask, flags, QUERY_CLOSEST, user_data), hit);
}
bool closest_hit(Address accel, Ray ray, uint mask, uint flags, out Hit hit) {
    return closest_hit(accel, ray, mask, flags, absent_near(accel), hit);
}
bool closest_hit(Address accel, Ray ray, out Hit hit) { return closest_hit(accel, ray, 0xffu, 0u, hit); }

// Finds any hit of them. Returns false if there is none; hit is then a miss.
bool any_hit(Address accel, Ray ray, uint mask, uint flags, Address user_data, out Hit hit) {
    return find_hit(accel, ray, trace_options(mask, flags, QUERY_ANY, user_data), hit);
}
bool any_hit(Address accel, Ray ray, uint mask, uint flags, out Hit hit) {
    return any_hit(accel, ray, mask, flags, absent_near(accel), hit);
}

// Returns whether anything is on the ray.
bool any_hit(Address accel, Ray ray, uint mask, uint flags) {
    TraceOptions options = trace_options(mask, flags, QUERY_ANY, absent_near(accel));
    options.features &= ~FEATURE_HITS;
    return trace(accel, ray, options).hit != 0u;
}
bool any_hit(Address accel, Ray ray) { return any_hit(accel, ray, 0xffu, 0u); }
#endif
