#version 460
#extension GL_GOOGLE_include_directive : require
INCLUDES
#include "twinray/glsl/surface.glsl"
layout(local_size_x = 64) in;
struct MeshInfo { float density; };
BUFFER_OF(MeshInfo, 4);
// Names that lines about the surface at a hit use.
layout(push_constant, scalar) uniform Push { REF(Ray) rays; REF(Hit) hits; Address accel; uint heat; } push;

void main()
{
    Address accel = push.accel;
    Ray ray = AT(push.rays, global_index());
    Hit hit = AT(push.hits, global_index());
    BLOCK
}
