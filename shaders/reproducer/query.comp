// SPDX-License-Identifier: MIT
// Traces one ray by a ray query, as programs that show a driver's fault do: see report/reproducer/reproducer.c.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 1) in;
layout(buffer_reference) buffer Answer
{
    uint is_hit, instance, triangle;
    float t, u, v;
};
layout(push_constant) uniform Push
{
    vec4 origin_t_min, direction_t_max;
    uvec2 scene; // address of the top level
    Answer answer;
};

void main()
{
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
