// SPDX-License-Identifier: MIT
// Three vertices per triangle, read by address.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
layout(location = 0) flat out uvec2 id;

const float NEAR = 0.1;

void main() {
    Body body = BodyList(args.bodies).items[gl_InstanceIndex];
    id = uvec2(gl_InstanceIndex, gl_VertexIndex / 3);
    uvec3 corners = IndexList(body.indices).items[id.y];
    vec3 position = VertexList(body.vertices).items[corners[gl_VertexIndex % 3]].position;
    vec3 way = transformed(body, vec4(position, 1.0)) - args.eye;
    float x = dot(way, args.right) / dot(args.right, args.right);
    float y = dot(way, args.up) / dot(args.up, args.up);
    gl_Position = vec4(x, -y, NEAR, dot(way, args.forward));
}
