// SPDX-License-Identifier: MIT
// Writes the committed hit. The hit record that runs shows the instance's offset, which no stage can read.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "shaders/conformance/pipeline.glsl"

layout(location = 0) rayPayloadInEXT uint is_hit;
hitAttributeEXT vec2 uv;

void main()
{
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
    AT(args.answers, i).to_world = Columns(gl_ObjectToWorldEXT[0], gl_ObjectToWorldEXT[1], gl_ObjectToWorldEXT[2],
                                           gl_ObjectToWorldEXT[3]);
    if (is_triangle)
    {
        AT(args.answers, i).is_front = is_front ? 1u : 0u;
        AT(args.answers, i).uv = uv;
    }
    is_hit = 1u;
}
