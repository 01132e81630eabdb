#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/query.glsl"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push {
    Address accel;
    REF(Hit) hit;
}
push;

void main() {
    Hit hit;
    closest_hit(push.accel, Ray(vec3(0.1f, 0.2f, 5.0f), 0.0f, vec3(0.0f, 0.0f, -1.0f), 100.0f), hit);
    AT(push.hit, 0) = hit;
}
