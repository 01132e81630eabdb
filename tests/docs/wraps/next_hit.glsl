#version 460
#extension GL_GOOGLE_include_directive : require
INCLUDES
layout(local_size_x = 64) in;
// Names that lines about successive hits use.
layout(push_constant, scalar) uniform Push { Address accel; REF(Ray) rays; Floats depths; float density; } push;

void main()
{
    Address accel = push.accel;
    Ray ray = AT(push.rays, global_index());
    float depth = 0.0, density = push.density;
    BLOCK
    AT(push.depths, global_index()) = depth;
}
