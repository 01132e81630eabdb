// SPDX-License-Identifier: MIT
// Each invocation handles one shadow ray: its light counts if nothing is in the way.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "path.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { WaveArgs args; };

// [main]
void main() {
    uint i = global_index();
    if (i >= AT(args.shadows.count, 0) || AT(args.hits, i).hit != 0u) return;
    Path path = AT(args.shadows.paths, i);
    AT(args.radiances, place_of(args, path)) += path.weight;
}
