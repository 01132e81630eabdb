// SPDX-License-Identifier: MIT
// Traces one ray by a ray query, as programs that show a driver's fault do: see report/reproducer/reproducer.c; and by
// a ray tracing pipeline, for drivers without ray queries and for faults of pipelines.
#version 460
#if defined(KERNEL_QUERY)
#extension GL_EXT_ray_query : require
#else
#extension GL_EXT_ray_tracing : require
#endif
#if defined(KERNEL_QUERY) || defined(STAGE_RGEN)
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(buffer_reference) buffer Answer {
    uint is_hit, instance, triangle;
    float t, u, v;
};
layout(push_constant) uniform Push {
    vec4 origin_t_min, direction_t_max;
    uvec2 scene;  // address of the top level
    Answer answer;
};
#endif

struct Payload {
    uint is_hit, instance, triangle;
    float t, u, v;
};

#ifdef KERNEL_QUERY
layout(local_size_x = 1) in;

void main() {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(scene), gl_RayFlagsOpaqueEXT, 0xff, origin_t_min.xyz,
                          origin_t_min.w, direction_t_max.xyz, direction_t_max.w);
    while (rayQueryProceedEXT(query)) {}
    answer.is_hit = 0u;
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) return;
    vec2 uv = rayQueryGetIntersectionBarycentricsEXT(query, true);
    answer.is_hit = 1u;
    answer.instance = rayQueryGetIntersectionInstanceIdEXT(query, true);
    answer.triangle = rayQueryGetIntersectionPrimitiveIndexEXT(query, true);
    answer.t = rayQueryGetIntersectionTEXT(query, true);
    answer.u = uv.x;
    answer.v = uv.y;
}
#endif

#ifdef STAGE_RGEN
layout(location = 0) rayPayloadEXT Payload payload;

void main() {
    traceRayEXT(accelerationStructureEXT(scene), gl_RayFlagsOpaqueEXT, 0xff, 0, 0, 0, origin_t_min.xyz, origin_t_min.w,
                direction_t_max.xyz, direction_t_max.w, 0);
    answer.is_hit = payload.is_hit;
    answer.instance = payload.instance;
    answer.triangle = payload.triangle;
    answer.t = payload.t;
    answer.u = payload.u;
    answer.v = payload.v;
}
#endif

#if defined(STAGE_RCHIT) || defined(STAGE_RMISS)
layout(location = 0) rayPayloadInEXT Payload payload;
#endif

#ifdef STAGE_RCHIT
hitAttributeEXT vec2 uv;

void main() { payload = Payload(1u, gl_InstanceID, gl_PrimitiveID, gl_HitTEXT, uv.x, uv.y); }
#endif

#ifdef STAGE_RMISS
void main() { payload = Payload(0u, 0u, 0u, 0.0, 0.0, 0.0); }
#endif
