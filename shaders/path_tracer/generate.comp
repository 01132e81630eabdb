// SPDX-License-Identifier: MIT
// One camera ray per pixel, through a uniformly random point of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/ray.h"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/wave.h"
#include "shaders/shared/random.h"
layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { GenerateArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    uint index = AT(args.pixels, i), key = picture_index(args.window, index);
    uvec2 pixel = uvec2(key % args.window.picture_width, key / args.window.picture_width);
    vec2 jitter = unit_floats(sample_pair(key, args.sample_index, 0u, args.seed));
    vec2 inside = (vec2(pixel) + jitter) / vec2(args.window.picture_width, args.picture_height);
    vec3 across = args.camera.right * (2.0 * inside.x - 1.0) + args.camera.up * (1.0 - 2.0 * inside.y);
    bool is_orthographic = args.camera.orthographic != 0u;
    Ray ray;
    ray.origin = args.camera.origin + (is_orthographic ? across : vec3(0.0));
    ray.direction = normalize(args.camera.forward + (is_orthographic ? vec3(0.0) : across));
    ray.t_min = 0.0;
    ray.t_max = uintBitsToFloat(0x7f800000u);
    PathState path;
    path.throughput = vec3(1.0);
    path.pdf = 0.0;
    path.pixel = index;
    path.progress = 0u;
    path.medium = 0u;
    AT(args.rays, i) = ray;
    AT(args.paths, i) = path;
}
