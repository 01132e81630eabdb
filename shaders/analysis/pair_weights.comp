// SPDX-License-Identifier: MIT
// Marks the weights of rays that something blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/pair_rays.h"
layout(local_size_x = CHUNK) in;
layout(push_constant, scalar) uniform Push { PairWeightsArgs args; };

void main()
{
    uint i = global_index();
    if (i < args.count && AT(args.hits, i).hit != 0u) AT(args.weights, i) = -AT(args.weights, i);
}
