// SPDX-License-Identifier: MIT
// Rays that leave faces, a group for each chunk, and the target that each of them meets.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/analysis/face.glsl"
#include "shaders/analysis/view_factors.h"
layout(local_size_x = CHUNK) in;

#ifdef KERNEL_FACE_RAYS
layout(push_constant, scalar) uniform Push { FaceRaysArgs args; };

void main() {
    uint i = gl_LocalInvocationIndex;
    RayChunk chunk = AT(args.chunks, group_index());
    vec4 u = sample_of(args, chunk.face, i / SAMPLES_OF_CHUNK, chunk.first + i % SAMPLES_OF_CHUNK);
    AT(args.rays, global_index()) = diffuse_ray(args.table, chunk.face, u, args.is_two_sided != 0u);
}
#endif

#ifdef KERNEL_FACE_TARGETS
layout(push_constant, scalar) uniform Push { FaceTargetsArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    AT(args.targets, i) = target_of(args, AT(args.rays, i), AT(args.hits, i));
}
#endif
