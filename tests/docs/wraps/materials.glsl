#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/multi_type_set.glsl"
#include "twinray/glsl/textures.glsl"
#include "tests/docs/wraps/materials.h"
layout(local_size_x = 64) in;
// Functions of a kernel that gets a set and textures.
layout(push_constant, scalar) uniform Push { MaterialSet materials; TextureTable textures; REF(SetKey) keys; } push;
BLOCK
void main() {}
