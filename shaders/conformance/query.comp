// SPDX-License-Identifier: MIT
// One ray query for each shot, whose flags, mask, interval and treatment of candidates are data. Compiled a second time
// with PRIMITIVE_CULLING for devices that let rays skip triangles or boxes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
#ifdef PRIMITIVE_CULLING
#extension GL_EXT_ray_flags_primitive_culling : require
#endif
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/ray.h"
#include "shaders/conformance/query.h"
#ifdef PRIMITIVE_CULLING
layout(primitive_culling);
#endif
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { QueryArgs args; };

void note_candidate(uint shot, uint position, bool is_box, rayQueryEXT query) {
    if (position >= args.slots) return;
    AT(args.candidates, shot * args.slots + position) = candidate_name(
        is_box, rayQueryGetIntersectionInstanceIdEXT(query, false),
        rayQueryGetIntersectionGeometryIndexEXT(query, false), rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
}

// Returns the end of the ray behind which nothing is found any more.
float end_of(rayQueryEXT query, Ray ray) {
    bool has_hit = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
    return has_hit ? rayQueryGetIntersectionTEXT(query, true) : ray.t_max;
}

void consider_triangle(Shot shot, rayQueryEXT query, inout Answer answer) {
    answer.triangles++;
    float t = rayQueryGetIntersectionTEXT(query, false);
    if (!(t > shot.ray.t_min && t < shot.ray.t_max)) answer.outside++;
    if (is_refused(shot, rayQueryGetIntersectionPrimitiveIndexEXT(query, false))) return;
    rayQueryConfirmIntersectionEXT(query);
}

void consider_box(Shot shot, rayQueryEXT query, inout Answer answer) {
    answer.boxes++;
    if (rayQueryGetIntersectionCandidateAABBOpaqueEXT(query)) answer.opaque_boxes++;
    uint primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
    float t = box_t_of(shot, primitive);
    if (is_refused(shot, primitive) || !(t >= shot.ray.t_min && t <= end_of(query, shot.ray))) return;
    rayQueryGenerateIntersectionEXT(query, t);
}

void read_committed(rayQueryEXT query, inout Answer answer) {
    uint kind = rayQueryGetIntersectionTypeEXT(query, true);
    if (kind == gl_RayQueryCommittedIntersectionNoneEXT) return;
    bool is_triangle = kind == gl_RayQueryCommittedIntersectionTriangleEXT;
    answer.kind = is_triangle ? ANSWER_TRIANGLE : ANSWER_BOX;
    answer.t = rayQueryGetIntersectionTEXT(query, true);
    answer.instance = rayQueryGetIntersectionInstanceIdEXT(query, true);
    answer.custom_index = rayQueryGetIntersectionInstanceCustomIndexEXT(query, true);
    answer.sbt_offset = rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, true);
    answer.geometry = rayQueryGetIntersectionGeometryIndexEXT(query, true);
    answer.primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, true);
    answer.object_origin = rayQueryGetIntersectionObjectRayOriginEXT(query, true);
    answer.object_direction = rayQueryGetIntersectionObjectRayDirectionEXT(query, true);
    mat4x3 to_world = rayQueryGetIntersectionObjectToWorldEXT(query, true);
    answer.to_world = Columns(to_world[0], to_world[1], to_world[2], to_world[3]);
    if (!is_triangle) return;
    answer.is_front = rayQueryGetIntersectionFrontFaceEXT(query, true) ? 1u : 0u;
    answer.uv = rayQueryGetIntersectionBarycentricsEXT(query, true);
}

Answer nothing() {
    Answer answer;
    answer.kind = ANSWER_MISS;
    answer.t = 0.0f;
    answer.instance = answer.custom_index = answer.sbt_offset = answer.geometry = answer.primitive = 0u;
    answer.is_front = 0u;
    answer.uv = vec2(0.0f);
    answer.object_origin = answer.object_direction = vec3(0.0f);
    answer.to_world = Columns(vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f));
    answer.triangles = answer.boxes = answer.opaque_boxes = answer.outside = 0u;
    return answer;
}

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    Shot shot = AT(args.shots, i);
    Answer answer = nothing();
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(args.structure), shot.flags, shot.cull_mask, shot.ray.origin,
                          shot.ray.t_min, shot.ray.direction, shot.ray.t_max);
    while (rayQueryProceedEXT(query)) {
        bool is_box = rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionAABBEXT;
        note_candidate(i, answer.triangles + answer.boxes, is_box, query);
        if (is_box)
            consider_box(shot, query, answer);
        else
            consider_triangle(shot, query, answer);
    }
    read_committed(query, answer);
    AT(args.answers, i) = answer;
}
