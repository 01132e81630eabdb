#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/soa.glsl"
#include "twinray/glsl/textures.glsl"
#include "tests/docs/wraps/materials.h"
layout(local_size_x = 64) in;
// Names that lines of a kernel about textures and queues use.
layout(push_constant, scalar) uniform Push { TextureTable textures; TextureRef heat; RayQueue queue, next; } push;

void main()
{
    uint i = global_index(), pixel = i;
    vec2 uv = vec2(0.5);
    Painted painted = Painted(push.heat, 1.0);
    BLOCK
}
