// SPDX-License-Identifier: MIT
// Adds the light of sun and sky to the surface that each pixel sees.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/ray.h"
#include "scene.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

// [light]
vec3 light(Seen seen, uint pixel) {
    float sun = max(dot(seen.normal, TO_SUN), 0.0), sky = 1.0;
    if (args.rays_per_pixel > 0u) {
        REF(Hit) hits = REF(Hit)(args.hits);
        uint first = pixel * args.rays_per_pixel, blocked = 0u;
        sun *= 1.0 - float(AT(hits, first).hit);  // the first ray went to the sun, the others to the sky
        for (uint i = 1u; i < args.rays_per_pixel; ++i) blocked += AT(hits, first + i).hit;
        sky = 1.0 - float(blocked) / float(args.rays_per_pixel - 1u);
    }
    return seen.body.color * (sun * vec3(0.85, 0.8, 0.7) + sky * vec3(0.3, 0.34, 0.42));
}
// [/light]

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= args.width || pixel.y >= args.height) return;
    uint index = pixel.y * args.width + pixel.x;
    Seen seen;
    vec3 color = look(pixel, seen) ? light(seen, index) : vec3(0.6, 0.72, 0.9);
    uvec3 bytes = uvec3(255.0 * pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2)) + 0.5);
    ColorList(args.colors).items[index] = bytes.r | (bytes.g << 8) | (bytes.b << 16);
}
