// SPDX-License-Identifier: MIT
// Traces one ray through a HwTlasHeader by a ray query.
#ifndef TWINRAY_HWTLAS_RAY_QUERY_GLSL
#define TWINRAY_HWTLAS_RAY_QUERY_GLSL
#include "shaders/hwtlas/ids.glsl"

Candidate candidate_of(HwTlasHeader scene, rayQueryEXT query, bool is_front, TraceOptions options) {
    return candidate_of(scene, rayQueryGetIntersectionInstanceIdEXT(query, false),
                        rayQueryGetIntersectionPrimitiveIndexEXT(query, false),
                        rayQueryGetIntersectionInstanceCustomIndexEXT(query, false), is_front, options);
}

bool has_hit(rayQueryEXT query) {
    return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

void consider_triangle(HwTlasHeader scene, rayQueryEXT query, TraceOptions options) {
    Candidate candidate = candidate_of(scene, query, rayQueryGetIntersectionFrontFaceEXT(query, false), options);
    if (accept_hit(candidate, t_of_given(rayQueryGetIntersectionTEXT(query, false), options),
                   rayQueryGetIntersectionBarycentricsEXT(query, false)))
        rayQueryConfirmIntersectionEXT(query);
}

// uv: the values of the box that was hit last, for which the query has no place.
void consider_box(HwTlasHeader scene, rayQueryEXT query, Ray ray, TraceOptions options, inout vec2 uv) {
    Candidate candidate = candidate_of(scene, query, false, options);
    Ray ray_local;
    ray_local.origin = rayQueryGetIntersectionObjectRayOriginEXT(query, false);
    ray_local.direction = rayQueryGetIntersectionObjectRayDirectionEXT(query, false);
    ray_local.t_min = ray.t_min;
    ray_local.t_max = has_hit(query) ? rayQueryGetIntersectionTEXT(query, true) : ray.t_max;
    float t = 0.0f;
    vec2 at = vec2(0.0f);
    if (!intersect_primitive(candidate, ray_local, t, at)) return;
    if (!(t > ray_local.t_min && t < ray_local.t_max)) return;
    bool is_non_opaque =
        (options.features & FEATURE_FILTERS) != 0u && !rayQueryGetIntersectionCandidateAABBOpaqueEXT(query);
    if (is_non_opaque && !accept_hit(candidate, t_of_given(t, options), at)) return;
    rayQueryGenerateIntersectionEXT(query, t);
    uv = at;
}

Hit trace_float32(Address accel, Ray ray, TraceOptions options) {
    if (!is_traceable(ray)) return miss();
    ray.t_min = max(ray.t_min, 0.0f);
    HwTlasHeader scene = AT(REF(HwTlasHeader)(accel), 0);
    uint flags = ray_flags(options, gl_RayFlagsOpaqueEXT, gl_RayFlagsTerminateOnFirstHitEXT);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(scene.tlas), flags, options.mask, ray.origin, ray.t_min,
                          ray.direction, ray.t_max);
    vec2 uv = vec2(0.0f);
    if ((options.features & (FEATURE_BOXES | FEATURE_FILTERS)) == 0u)
        rayQueryProceedEXT(query);  // opaque triangles never come up as candidates: one call runs to the end
    else
        while (rayQueryProceedEXT(query)) {
            bool is_triangle =
                (options.features & FEATURE_BOXES) == 0u ||
                rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionTriangleEXT;
            if (is_triangle)
                consider_triangle(scene, query, options);
            else
                consider_box(scene, query, ray, options, uv);
        }
    if (!has_hit(query)) return miss();
    bool is_triangle = (options.features & FEATURE_BOXES) == 0u ||
                       rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT;
    bool is_front = false;
    if (is_triangle) {
        uv = rayQueryGetIntersectionBarycentricsEXT(query, true);
        is_front = rayQueryGetIntersectionFrontFaceEXT(query, true);
    }
    return hit_of(candidate_of(scene, rayQueryGetIntersectionInstanceIdEXT(query, true),
                               rayQueryGetIntersectionPrimitiveIndexEXT(query, true),
                               rayQueryGetIntersectionInstanceCustomIndexEXT(query, true), is_front, options),
                  rayQueryGetIntersectionTEXT(query, true), uv);
}
#endif
