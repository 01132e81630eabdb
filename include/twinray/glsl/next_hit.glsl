// SPDX-License-Identifier: MIT
// Hits of a ray one after the other, in a kernel of one's own; instead of twinray/glsl/query.glsl.
//
//     Hit hit = no_hit();
//     while (next_hit(accel, ray, hit)) depth += hit.t;
//
// By t, then by (instance, primitive), so that triangles at one distance each come once; by hardware a driver may
// choose among them and pass some over. Of triangles, at levels fast and watertight; kernels with a program of their
// own (twinray/glsl/program.h) have no use of it. Each call is a traversal from the ray's origin on: for all hits of
// many rays AllHits is faster.
#ifndef TWINRAY_NEXT_HIT_GLSL
#define TWINRAY_NEXT_HIT_GLSL
#define TWINRAY_PROGRAM
#include "twinray/glsl/query.glsl"

Hit twinray_passed; // by the traversal under way

// Before the first.
Hit no_hit() { return miss(); }

bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) { return false; }

bool accept_hit(Candidate candidate, float t, vec2 uv)
{
    if (twinray_passed.hit == 0u || t > twinray_passed.t) return true;
    if (t < twinray_passed.t) return false;
    if (candidate.instance_index != twinray_passed.instance_index)
        return candidate.instance_index > twinray_passed.instance_index;
    return candidate.primitive_index > twinray_passed.primitive_index;
}

// The hit behind `hit`, which is no_hit() or what a call before gave; false: there is none, and hit is a miss.
bool next_hit(Address accel, Ray ray, uint mask, uint flags, inout Hit hit)
{
    twinray_passed = hit;
    if (hit.hit != 0u) ray.t_min = uintBitsToFloat(floatBitsToUint(hit.t) - 1u);
    TraceOptions options = trace_options(mask, flags | ALL_NON_OPAQUE, QUERY_CLOSEST, absent_near(accel));
    options.features |= FEATURE_FILTERS; // whatever the kernel was specialised for: accept_hit is one
    options.level = min(options.level, LEVEL_WATERTIGHT);
    hit = trace(accel, ray, options);
    return hit.hit != 0u;
}
bool next_hit(Address accel, Ray ray, inout Hit hit) { return next_hit(accel, ray, 0xffu, 0u, hit); }
#endif
