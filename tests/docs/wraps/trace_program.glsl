#version 460
#extension GL_GOOGLE_include_directive : require
#define TWINRAY_PROGRAM
#include "twinray/glsl/common.glsl"
BLOCK
// The traversals call it like this.
#include "twinray/glsl/query.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { Address accel; REF(Ray) rays; REF(Hit) hits; } push;

void main()
{
    Hit hit;
    closest_hit(push.accel, AT(push.rays, global_index()), hit);
    AT(push.hits, global_index()) = hit;
}
