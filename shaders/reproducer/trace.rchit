// SPDX-License-Identifier: MIT
#version 460
#extension GL_EXT_ray_tracing : require
struct Payload
{
    uint is_hit, instance, triangle;
    float t, u, v;
};
layout(location = 0) rayPayloadInEXT Payload payload;
hitAttributeEXT vec2 uv;

void main() { payload = Payload(1u, gl_InstanceID, gl_PrimitiveID, gl_HitTEXT, uv.x, uv.y); }
