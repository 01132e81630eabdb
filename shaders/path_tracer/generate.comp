// SPDX-License-Identifier: MIT
// Makes one camera ray per pixel, through a random point of its filter's area and of the lens.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/rays.h"
#include "twinray/glsl/sampling.h"
#include "twinray/glsl/soa.h"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/wave.h"
#include "shaders/path_tracer/camera.h"
#include "twinray/glsl/random.h"
layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { GenerateArgs args; };
layout(constant_id = PT_FILTER) const uint FILTER = FILTER_BOX;

const uint PAIR_LENS = 0xffffffffu;  // of random dimensions; vertices of paths count theirs from 1

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    WaveData wave = AT(args.wave, 0);
    uint index = AT(args.pixels, i), key = picture_index(wave.window, index);
    uvec2 pixel = uvec2(key % wave.window.picture_width, key / wave.window.picture_width);
    vec2 offset = filter_offset(FILTER, unit_floats(sample_pair(key, args.sample_index, 0u, args.seed)));
    vec2 inside = (vec2(pixel) + 0.5 + offset) / vec2(wave.window.picture_width, args.picture_height);
    vec2 lens = vec2(0.0);
    if (args.camera.lens_radius > 0.0) lens = unit_floats(sample_pair(key, args.sample_index, PAIR_LENS, args.seed));
    AT(wave.rays, i) = camera_ray(args.camera, vec2(2.0 * inside.x - 1.0, 1.0 - 2.0 * inside.y), lens);
    AT(wave.paths.throughput, i) = vec3(1.0);
    AT(wave.paths.pdf, i) = 0.0;
    AT(wave.paths.pixel, i) = index;
    AT(wave.paths.progress, i) = 0u;
    if (!is_absent(wave.media)) AT(wave.media, i) = 0u;
}
