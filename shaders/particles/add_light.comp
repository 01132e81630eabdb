// SPDX-License-Identifier: MIT
// Writes the mean of a pixel's rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/particles/picture.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { AddLightArgs args; };

void main()
{
    uint pixel = global_index();
    if (pixel >= args.count) return;
    vec3 sum = vec3(0.0);
    for (uint i = pixel * args.samples; i < (pixel + 1u) * args.samples; i++)
    {
        Light light = AT(args.light, i);
        sum += light.indirect;
        if (AT(args.shadow_hits, i).hit == 0u) sum += light.direct;
    }
    AT(args.picture, pixel) = sum / float(args.samples);
}
