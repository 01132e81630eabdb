// SPDX-License-Identifier: MIT
// Finds the target of each ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/view_factors.h"
layout(local_size_x = CHUNK) in;
layout(push_constant, scalar) uniform Push { FaceTargetsArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    AT(args.targets, i) = target_of(args, AT(args.rays, i), AT(args.hits, i));
}
