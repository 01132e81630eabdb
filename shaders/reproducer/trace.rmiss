// SPDX-License-Identifier: MIT
#version 460
#extension GL_EXT_ray_tracing : require
struct Payload
{
    uint is_hit, instance, triangle;
    float t, u, v;
};
layout(location = 0) rayPayloadInEXT Payload payload;

void main() { payload = Payload(0u, 0u, 0u, 0.0, 0.0, 0.0); }
