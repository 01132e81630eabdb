// SPDX-License-Identifier: MIT
// A group makes the rays of a chunk.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/pair_rays.h"
layout(local_size_x = CHUNK) in;
layout(push_constant, scalar) uniform Push { PairRaysArgs args; };

void main()
{
    uint i = gl_LocalInvocationIndex;
    PairChunk chunk = AT(args.chunks, group_index());
    vec4 u = pair_sample_of(args, chunk, i / SAMPLES_OF_CHUNK, chunk.first + i % SAMPLES_OF_CHUNK);
    PairRay pair = pair_ray(args, chunk, u);
    AT(args.rays, global_index()) = pair.ray;
    AT(args.weights, global_index()) = pair.weight;
}
