// SPDX-License-Identifier: MIT
// Makes the rays of a run of faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/sky_rays.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SkyRaysArgs args; };

void main()
{
    uint i = global_index();
    if (i < args.ray_count) AT(args.rays, i) = sky_ray(args, i);
}
