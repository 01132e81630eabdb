// SPDX-License-Identifier: MIT
// The stages of a pipeline that takes the same shots and gives the same answers as query.comp; the arguments are in a
// buffer. Ray generation is compiled a second time with PRIMITIVE_CULLING, as query.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#ifdef PRIMITIVE_CULLING
#extension GL_EXT_ray_flags_primitive_culling : require
#endif
#include "twinray/glsl/common.glsl"
#include "shaders/shared/trace.h"
#include "shaders/conformance/query.h"
layout(push_constant, scalar) uniform Push { TraceArgs launch; };

QueryArgs arguments() { return AT(REF(QueryArgs)(launch.user_data), 0); }
uint shot_index() { return launch.first + gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x; }

#ifdef STAGE_RGEN
// Traces one shot per invocation.
#ifdef PRIMITIVE_CULLING
layout(primitive_culling);
#endif
layout(location = 0) rayPayloadEXT uint is_hit;

void main() {
    uint i = shot_index();
    if (i >= launch.count) return;
    QueryArgs args = arguments();
    Shot shot = AT(args.shots, i);
    is_hit = 0u;
    traceRayEXT(accelerationStructureEXT(args.structure), shot.flags, shot.cull_mask, 0u, 0u, 0u, shot.ray.origin,
                shot.ray.t_min, shot.ray.direction, shot.ray.t_max, 0);
    AT(args.answers, i).opaque_boxes = OPACITY_UNKNOWN;
    if (is_hit == 0u) AT(args.answers, i).kind = ANSWER_MISS;
}
#endif

#ifdef STAGE_RMISS
layout(location = 0) rayPayloadInEXT uint is_hit;

void main() { is_hit = 0u; }
#endif

#ifdef STAGE_RCHIT
// Writes the committed hit. The hit record that runs shows the instance's offset, which no stage can read.
layout(location = 0) rayPayloadInEXT uint is_hit;
hitAttributeEXT vec2 uv;

void main() {
    QueryArgs args = arguments();
    uint i = shot_index();
    bool is_front = gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT;
    bool is_triangle = is_front || gl_HitKindEXT == gl_HitKindBackFacingTriangleEXT;
    AT(args.answers, i).kind = is_triangle ? ANSWER_TRIANGLE : ANSWER_BOX;
    AT(args.answers, i).t = gl_HitTEXT;
    AT(args.answers, i).instance = gl_InstanceID;
    AT(args.answers, i).custom_index = gl_InstanceCustomIndexEXT;
    AT(args.answers, i).geometry = gl_GeometryIndexEXT;
    AT(args.answers, i).primitive = gl_PrimitiveID;
    AT(args.answers, i).object_origin = gl_ObjectRayOriginEXT;
    AT(args.answers, i).object_direction = gl_ObjectRayDirectionEXT;
    AT(args.answers, i).to_world =
        Columns(gl_ObjectToWorldEXT[0], gl_ObjectToWorldEXT[1], gl_ObjectToWorldEXT[2], gl_ObjectToWorldEXT[3]);
    if (is_triangle) {
        AT(args.answers, i).is_front = is_front ? 1u : 0u;
        AT(args.answers, i).uv = uv;
    }
    is_hit = 1u;
}
#endif

#if defined(STAGE_RAHIT) || defined(STAGE_RINT)
hitAttributeEXT vec2 uv;

// Intersections have no payload, so counters lie in the answer, which begins as zeros.
void note_candidate(QueryArgs args, uint shot, bool is_box) {
    uint boxes = atomicAdd(AT(args.answers, shot).boxes, is_box ? 1u : 0u);
    uint triangles = atomicAdd(AT(args.answers, shot).triangles, is_box ? 0u : 1u);
    uint position = boxes + triangles;
    if (position >= args.slots) return;
    AT(args.candidates, shot * args.slots + position) =
        candidate_name(is_box, gl_InstanceID, gl_GeometryIndexEXT, gl_PrimitiveID);
}
#endif

#ifdef STAGE_RAHIT
// Decides about triangles that are not opaque, and boxes for which an intersection was reported.
void main() {
    bool is_triangle =
        gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT || gl_HitKindEXT == gl_HitKindBackFacingTriangleEXT;
    if (!is_triangle) return;  // the intersection shader has refused all that must be refused
    QueryArgs args = arguments();
    uint i = shot_index();
    Shot shot = AT(args.shots, i);
    note_candidate(args, i, false);
    if (!(gl_HitTEXT > shot.ray.t_min && gl_HitTEXT < shot.ray.t_max)) atomicAdd(AT(args.answers, i).outside, 1u);
    if (is_refused(shot, gl_PrimitiveID)) ignoreIntersectionEXT;
}
#endif

#ifdef STAGE_RINT
// Reports boxes that a ray may meet.
void main() {
    QueryArgs args = arguments();
    uint i = shot_index();
    Shot shot = AT(args.shots, i);
    note_candidate(args, i, true);
    if (is_refused(shot, gl_PrimitiveID)) return;
    uv = vec2(0.0f);
    reportIntersectionEXT(box_t_of(shot, gl_PrimitiveID), 0u);  // does nothing outside of the interval
}
#endif
