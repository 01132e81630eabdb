// SPDX-License-Identifier: MIT
// [waves]
// Computes the water's vertices at a time.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "pond.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { MoveArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.vertices) return;
    vec2 place = vec2(AT(args.positions, 3u * i), AT(args.positions, 3u * i + 2u));
    AT(args.positions, 3u * i + 1u) = height_of(place, args.time);
}
