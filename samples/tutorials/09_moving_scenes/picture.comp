// SPDX-License-Identifier: MIT
// Each invocation draws one pixel: water or ball, the sun with its shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/query.glsl"
#include "twinray/glsl/surface.glsl"
#include "twinray/glsl/spawn.glsl"
#include "pond.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PictureArgs args; };

const float EVERYWHERE = 1e30;  // t_max

// [radiance]
vec3 radiance(Ray ray) {
    Hit hit;
    if (!closest_hit(args.accel, ray, hit)) return vec3(0.95, 0.96, 0.97);
    Surface surface = surface_at(args.accel, ray, hit);
    vec3 normal = dot(surface.normal, ray.direction) < 0.0 ? surface.normal : -surface.normal;
    vec3 to_sun = normalize(vec3(-0.7, 0.8, 0.3));
    bool is_front = dot(surface.point.normal, to_sun) > 0.0;
    bool is_lit = dot(normal, to_sun) > 0.0 &&
                  !any_hit(args.accel, Ray(spawn_position(surface.point, is_front), 0.0, to_sun, EVERYWHERE));
    vec3 color = hit.custom_index == 1u ? vec3(0.9, 0.35, 0.15) : vec3(0.15, 0.4, 0.55);
    return color * (0.3 + 0.15 * normal.y + 0.8 * (is_lit ? dot(normal, to_sun) : 0.0));
}
// [/radiance]

void main() {
    uint i = global_index();
    if (i >= args.width * args.height) return;
    vec2 at = (vec2(i % args.width, i / args.width) + 0.5 - 0.5 * vec2(args.width, args.height)) / float(args.height);
    vec3 forward = normalize(vec3(-0.6, -0.75, -1.0)), right = normalize(cross(forward, vec3(0, 1, 0)));
    vec3 direction = normalize(forward + 0.75 * (at.x * right - at.y * cross(right, forward)));
    vec3 color = radiance(Ray(-4.8 * forward, 0.0, direction, EVERYWHERE));
    uvec3 bytes = uvec3(255.0 * pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2)) + 0.5);
    AT(args.pixels, i) = bytes.r | (bytes.g << 8) | (bytes.b << 16);
}
