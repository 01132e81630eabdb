// SPDX-License-Identifier: MIT
// [program]
// The wire of the cage and the ball, as a trace program.
#include "twinray/glsl/program.h"
#include "cage.h"

// A box stands for a ball about the middle of object space, which is hit where a ray enters it.
bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) {
    vec3 origin = ray_local.origin, direction = ray_local.direction;
    float along = -dot(origin, direction), length2 = dot(direction, direction);
    vec3 nearest = origin + (along / length2) * direction;  // to the middle
    float inside = BALL_RADIUS * BALL_RADIUS - dot(nearest, nearest);
    if (along <= 0.0 || inside < 0.0) return false;
    t = along / length2 - sqrt(inside / length2);
    return true;
}

// A triangle of the cage consists only of a frame: where the weight of one of its corners is small.
bool accept_hit(Candidate candidate, float t, vec2 uv) { return min(min(uv.x, uv.y), 1.0 - uv.x - uv.y) < WIRE_WIDTH; }
