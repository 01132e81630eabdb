// SPDX-License-Identifier: MIT
// Rays between points of two faces, a group for each chunk, and then the marks of those that something blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/pair_rays.h"
layout(local_size_x = CHUNK) in;

#ifdef KERNEL_PAIR_RAYS
layout(push_constant, scalar) uniform Push { PairRaysArgs args; };

void main() {
    uint i = gl_LocalInvocationIndex;
    PairChunk chunk = AT(args.chunks, group_index());
    vec4 u = pair_sample_of(args, chunk, i / SAMPLES_OF_CHUNK, chunk.first + i % SAMPLES_OF_CHUNK);
    PairRay pair = pair_ray(args, chunk, u);
    AT(args.rays, global_index()) = pair.ray;
    AT(args.weights, global_index()) = pair.weight;
}
#endif

#ifdef KERNEL_PAIR_WEIGHTS
layout(push_constant, scalar) uniform Push { PairWeightsArgs args; };

void main() {
    uint i = global_index();
    if (i < args.count && AT(args.hits, i).hit != 0u) AT(args.weights, i) = -AT(args.weights, i);
}
#endif
