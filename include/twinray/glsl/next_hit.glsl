// SPDX-License-Identifier: MIT
// Hits of a ray one after the other, in the application's own kernel; instead of twinray/glsl/query.glsl.
//
//     Hit hit = no_hit();
//     while (next_hit(accel, ray, hit)) depth += hit.t;
//
// Hits come by t, then by (instance, primitive), so that each triangle at one distance comes once; with hardware, the
// driver may choose among these and skip some. It finds triangles only, at levels fast and watertight; kernels with a
// program of their own (twinray/glsl/program.h) cannot use it. Each call is a traversal from the ray's origin on:
// AllHits is faster for all hits of many rays.
#ifndef TWINRAY_NEXT_HIT_GLSL
#define TWINRAY_NEXT_HIT_GLSL
#define TWINRAY_PROGRAM
#include "twinray/glsl/query.glsl"

Hit twinray_passed;  // the current traversal has passed it

// Returns the value to begin with, before the first hit.
Hit no_hit() { return miss(); }

bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) { return false; }

bool accept_hit(Candidate candidate, float t, vec2 uv) {
    if (twinray_passed.hit == 0u || t > twinray_passed.t) return true;
    if (t < twinray_passed.t) return false;
    if (candidate.instance_index != twinray_passed.instance_index)
        return candidate.instance_index > twinray_passed.instance_index;
    return candidate.primitive_index > twinray_passed.primitive_index;
}

// Finds the hit behind `hit`, which is no_hit() or from the previous call. Returns false if there is none; hit is then
// a miss.
bool next_hit(Address accel, Ray ray, uint mask, uint flags, inout Hit hit) {
    twinray_passed = hit;
    if (hit.hit != 0u) ray.t_min = uintBitsToFloat(floatBitsToUint(hit.t) - 1u);
    TraceOptions options = trace_options(mask, flags | ALL_NON_OPAQUE, QUERY_CLOSEST, absent_near(accel));
    options.features |= FEATURE_FILTERS;  // whatever the kernel was specialised for: accept_hit is a filter
    options.level = min(options.level, LEVEL_WATERTIGHT);
    hit = trace(accel, ray, options);
    return hit.hit != 0u;
}
bool next_hit(Address accel, Ray ray, inout Hit hit) { return next_hit(accel, ray, 0xffu, 0u, hit); }
#endif
