// SPDX-License-Identifier: MIT
// The stages of the ray tracing pipeline, for drivers without ray queries. A user's program adds the last two.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "twinray/glsl/common.glsl"
#include "shaders/hwtlas/ids.glsl"
#if defined(STAGE_RGEN) && defined(TWINRAY_REFINED)
#include "shaders/shared/refine.h"
#endif

layout(constant_id = QUERY_CONSTANT) const uint TRACE_QUERY = QUERY_CLOSEST;
layout(constant_id = FEATURES_CONSTANT) const uint TRACE_FEATURES = FEATURES_ALL;
layout(push_constant, scalar) uniform Push { TraceArgs args; };

TraceOptions trace_options() {
    TraceOptions options;
    options.mask = args.mask;
    options.flags = args.flags;
    options.query = TRACE_QUERY;
    options.level = LEVEL_WATERTIGHT;  // the driver's test, whatever was asked for
    options.features = TRACE_FEATURES;
    options.user_data = args.user_data;
    return options;
}

HwTlasHeader scene() { return AT(REF(HwTlasHeader)(args.scene), 0); }

#ifdef STAGE_RGEN
// Traces one ray per invocation.
layout(location = 0) rayPayloadEXT Hit payload;

void main() {
    uint position = args.first + gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
    if (position >= ray_count(args.count, args.indirect_count)) return;
    uint i = ray_at(args.order, position);
    Ray given = load_ray(args.rays, i);
    Ray ray = given;
    float traced_from = 0.0f;
    TraceOptions options = trace_options();
#ifdef TWINRAY_REFINED
    RefineScene refinement = AT(REF(RefineScene)(scene().accel.refinement), 0);
    WorldBound bound = AT(refinement.bound, 0);
    options.given = given;
    options.instances = refinement.instances;
    ray = searched_ray(bound.lo, bound.hi, options);
    traced_from = float(options.advance);
    float step = REFINING_STEP;
#endif
    bool is_done = true;
    do {
        payload = miss();
        if (is_traceable(ray)) {
            payload.t = traced_from;  // for the any-hit stage
            uint flags = ray_flags(options, gl_RayFlagsOpaqueEXT, gl_RayFlagsTerminateOnFirstHitEXT);
            traceRayEXT(accelerationStructureEXT(scene().tlas), flags, args.mask, 0u, 0u, 0u, ray.origin,
                        max(ray.t_min, 0.0f), ray.direction, ray.t_max, 0);
        }
#ifdef TWINRAY_REFINED
        is_done = payload.hit == 0u || refine(payload, ray, step, options);
#endif
    } while (!is_done);
    if ((TRACE_FEATURES & FEATURE_HITS) != 0u)
        store_hit(args.hits, i, payload);
    else
        AT(args.hits, i).hit = payload.hit;
}
#endif

#ifdef STAGE_RMISS
layout(location = 0) rayPayloadInEXT Hit payload;

void main() { payload = miss(); }
#endif

#ifdef STAGE_RCHIT
layout(location = 0) rayPayloadInEXT Hit payload;
hitAttributeEXT vec2 uv;  // barycentrics of a triangle, values from the intersection for a box

void main() {
    Candidate found = candidate_of(scene(), gl_InstanceID, gl_PrimitiveID, gl_InstanceCustomIndexEXT,
                                   gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT, trace_options());
    payload = hit_of(found, gl_HitTEXT, uv);
}
#endif

#ifdef TWINRAY_PROGRAM
#include "twinray_program.glsl"
hitAttributeEXT vec2 uv;
#endif

#if defined(STAGE_RAHIT)
// Decides about hits of non-opaque instances.
layout(location = 0) rayPayloadInEXT Hit payload;  // t: by how far the traced ray begins ahead of the given one

void main() {
    Candidate found = candidate_of(scene(), gl_InstanceID, gl_PrimitiveID, gl_InstanceCustomIndexEXT,
                                   gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT, trace_options());
    if (!accept_hit(found, payload.t + gl_HitTEXT, uv)) ignoreIntersectionEXT;
}
#endif

#if defined(STAGE_RINT)
// Reports boxes that a ray may meet.
void main() {
    Candidate found =
        candidate_of(scene(), gl_InstanceID, gl_PrimitiveID, gl_InstanceCustomIndexEXT, false, trace_options());
    Ray ray_local;
    ray_local.origin = gl_ObjectRayOriginEXT;
    ray_local.direction = gl_ObjectRayDirectionEXT;
    ray_local.t_min = gl_RayTminEXT;
    ray_local.t_max = gl_RayTmaxEXT;
    float t = 0.0f;
    vec2 at = vec2(0.0f);
    if (!intersect_primitive(found, ray_local, t, at)) return;
    if (!(t > ray_local.t_min && t < ray_local.t_max)) return;
    uv = at;
    reportIntersectionEXT(t, 0u);
}
#endif
