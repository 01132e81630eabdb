// SPDX-License-Identifier: MIT
// A group makes the rays of a chunk.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/view_factors.h"
layout(local_size_x = CHUNK) in;
layout(push_constant, scalar) uniform Push { FaceRaysArgs args; };

void main()
{
    uint i = gl_LocalInvocationIndex;
    RayChunk chunk = AT(args.chunks, group_index());
    vec4 u = sample_of(args, chunk.face, i / SAMPLES_OF_CHUNK, chunk.first + i % SAMPLES_OF_CHUNK);
    AT(args.rays, global_index()) = diffuse_ray(args.table, chunk.face, u, args.is_two_sided != 0u);
}
