// SPDX-License-Identifier: MIT
// [kernel]
// Each invocation draws one pixel: a ray of the camera, then one to the sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TWINRAY_PROGRAM  // closest_hit and any_hit ask the functions of cage.glsl
#include "twinray/glsl/query.glsl"
#include "cage.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PictureArgs args; };

void main() {
    uint pixel = global_index();
    if (pixel >= args.size * args.size) return;
    Ray ray = camera_ray(pixel, args.size, 0.42);
    Hit hit;
    bool is_lit =
        closest_hit(args.accel, ray, hit) && !any_hit(args.accel, ray_to_sun(ray, hit), IN_THE_WAY_OF_LIGHT, 0u);
    uvec3 bytes = uvec3(255.0 * sqrt(min(color_of(ray, hit, is_lit), 1.0)) + 0.5);
    AT(args.pixels, pixel) = bytes.r | (bytes.g << 8) | (bytes.b << 16);
}
