// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "shaders/hwtlas/pipeline.glsl"

layout(location = 0) rayPayloadInEXT Hit payload;
hitAttributeEXT vec2 uv; // barycentrics of a triangle, values from the intersection for a box

void main()
{
    Candidate found = candidate_of(scene(), gl_InstanceID, gl_PrimitiveID, gl_InstanceCustomIndexEXT,
                                   gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT, trace_options());
    payload = hit_of(found, gl_HitTEXT, uv);
}
