// SPDX-License-Identifier: MIT
// [float]
// Moves the balls to their places at a time: half under water.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "pond.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { MoveArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.ball_count) return;
    vec2 place = place_of_ball(i);
    AT(args.balls, i).object_to_world.r0 = vec4(BALL_RADIUS, 0.0, 0.0, place.x);
    AT(args.balls, i).object_to_world.r1 = vec4(0.0, BALL_RADIUS, 0.0, height_of(place, args.time));
    AT(args.balls, i).object_to_world.r2 = vec4(0.0, 0.0, BALL_RADIUS, place.y);
}
