// SPDX-License-Identifier: MIT
// Copies floats, times a factor, from the caller's device memory, of which only the address is known.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/copies.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CopyFloatsArgs args; };

void main()
{
    uint index = global_index();
    if (index < args.count) AT(args.to, index) = AT(args.from, index) * args.factor;
}
