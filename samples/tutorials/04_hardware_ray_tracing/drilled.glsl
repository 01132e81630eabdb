// SPDX-License-Identifier: MIT
// [drilled]
// A round hole in the middle of each triangle: where no weight of a corner is far from 1/3.
#include "twinray/glsl/program.h"

bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) { return false; }

bool accept_hit(Candidate candidate, float t, vec2 uv) {
    vec3 from_middle = vec3(1.0 - uv.x - uv.y, uv) - 1.0 / 3.0;
    return length(from_middle) > 0.3;
}
