// SPDX-License-Identifier: MIT
// Adds the sums of one block of samples to the film, and clears them for the next block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/rays.h"
#include "twinray/glsl/soa.h"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/wave.h"
#include "shaders/path_tracer/film.h"
#include "shaders/path_tracer/weights.h"
layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { AccumulateArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    uint index = AT(args.pixels, i);
    vec3 sum = AT(args.sums, index).rgb;
    AT(args.sums, index).rgb = vec3(0.0);
    if (!is_finite(sum)) {
        atomicAdd(AT(args.counters, 0).non_finite, 1u);
        sum = vec3(0.0);
    }
    FilmPixel pixel = AT(args.film, index);
    film_add(pixel, sum, luminance(sum));
    AT(args.film, index) = pixel;
}
