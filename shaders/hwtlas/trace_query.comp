// SPDX-License-Identifier: MIT
// One ray query per invocation, for drivers with VK_KHR_ray_query.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/surface_area.h"
#include "shaders/shared/hw_scene.h"
#include "shaders/hwtlas/trace.glsl"

layout(local_size_x = 64) in;

Hit trace(Ray ray)
{
    uint flags = args.flags | gl_RayFlagsOpaqueEXT | (IS_ANY ? gl_RayFlagsTerminateOnFirstHitEXT : 0u);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(AT(args.scene, 0).tlas), flags, args.mask, ray.origin,
                          max(ray.t_min, 0.0f), ray.direction, ray.t_max);
    // Opaque triangles never come up as candidates, so one call runs the traversal to its end.
    rayQueryProceedEXT(query);
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) return miss();
    uvec2 ids = uvec2(rayQueryGetIntersectionInstanceIdEXT(query, true),
                      rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    return hit_of(ids, rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
                  rayQueryGetIntersectionTEXT(query, true), rayQueryGetIntersectionBarycentricsEXT(query, true));
}

void main()
{
    uint i = global_index();
    if (i >= ray_count(args.count, args.indirect_count)) return;
    Ray ray = AT(args.rays, i);
    Hit hit = miss();
    if (is_traceable(ray)) hit = trace(ray);
    AT(args.hits, i) = hit;
}
