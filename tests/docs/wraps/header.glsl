#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
layout(local_size_x = 64) in;
// A header that a kernel includes, and C++ as well.
BLOCK
void main() {}
