// Rays in a fragment shader, which has no memory of a workgroup: compiled for both accelerators.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TWINRAY_PRIVATE_STACK
#include "twinray/glsl/query.glsl"
layout(push_constant, scalar) uniform Push { Address accel; }
push;
layout(location = 0) in vec3 position;
layout(location = 0) out vec4 color;

void main() {
    Hit hit;
    bool is_lit = !any_hit(push.accel, Ray(position, 1e-3, vec3(0.0, 1.0, 0.0), 1e30));
    bool is_above = closest_hit(push.accel, Ray(position, 1e-3, vec3(0.0, -1.0, 0.0), 1e30), hit);
    color = vec4(is_lit ? 1.0 : 0.2, is_above ? hit.t : 0.0, 0.0, 1.0);
}
