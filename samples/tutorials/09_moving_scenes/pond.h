// SPDX-License-Identifier: MIT
// A pond with waves on which balls float: the common part of its kernels and C++.
#ifndef TUTORIALS_POND_H
#define TUTORIALS_POND_H
#include "twinray/glsl/instance.h"

// [height]
// Returns the height of the water at a place and a time.
FUNC float height_of(vec2 place, float time) {
    return 0.12f * sin(3.0f * place.x + 2.0f * time) + 0.08f * sin(4.0f * place.y - 1.0f * place.x + 3.0f * time);
}
// [/height]

const float BALL_RADIUS = 0.16f;
const uint BALLS_ACROSS = 5u;

FUNC vec2 place_of_ball(uint ball) {
    vec2 cell = vec2(float(ball % BALLS_ACROSS), float(ball / BALLS_ACROSS));
    return cell * 0.7f - vec2(1.4f, 1.4f);
}

// [args]
struct MoveArgs {
    Floats positions;  // of the water's vertices, three each
    REF(InstanceRecord) balls;
    uint vertices;
    uint ball_count;
    float time;
};

struct PictureArgs {
    Address accel;
    Uints pixels;  // red, green, blue from the low byte
    uint width;
    uint height;
};
// [/args]
#endif
