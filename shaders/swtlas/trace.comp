// SPDX-License-Identifier: MIT
// Traces a batch of rays, one per invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/build.h"
#include "shaders/shared/traverse.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint QUERY = QUERY_CLOSEST;
layout(push_constant, scalar) uniform Push { SwTraceArgs args; };

void main()
{
    uint i = global_index();
    if (i >= ray_count(args.count, args.indirect_count)) return;
    AT(args.hits, i) = traverse(AT(args.scene, 0), AT(args.rays, i), args.mask, args.flags, QUERY);
}
