// SPDX-License-Identifier: MIT
// Each invocation answers for four rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/visible.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { VisibleArgs args; };

void main()
{
    uint word = global_index();
    if (word >= (args.ray_count + 3u) / 4u) return;
    uint bytes = 0u;
    for (uint k = 0u; k < 4u; ++k)
    {
        uint i = 4u * word + k;
        if (i < args.ray_count && AT(args.rays, i).t_max > 0.0f && AT(args.hits, i).hit == 0u) bytes |= 1u << 8u * k;
    }
    AT(args.answers, word) = bytes;
}
