// SPDX-License-Identifier: MIT
// Shades one pixel per invocation: the visible surface, its normal, the sun with its shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/query.glsl"
#include "twinray/glsl/surface.glsl"
#include "twinray/glsl/spawn.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    Address accel;
    Uints pixels;  // red, green, blue from the low byte
    uint width;
    uint height;
}
push;

const float EVERYWHERE = 1e30;  // t_max

vec3 radiance(Ray ray) {
    Hit hit;
    vec3 sky = mix(vec3(0.9, 0.92, 0.95), vec3(0.35, 0.5, 0.75), 0.5 + 0.5 * ray.direction.y);
    if (!closest_hit(push.accel, ray, hit)) return sky;
    Surface surface = surface_at(push.accel, ray, hit);
    vec3 normal = dot(surface.normal, ray.direction) < 0.0 ? surface.normal : -surface.normal;
    vec3 to_sun = normalize(vec3(0.5, 0.8, 0.6));
    bool is_front = dot(surface.point.normal, to_sun) > 0.0;
    bool is_lit = dot(normal, to_sun) > 0.0 &&
                  !any_hit(push.accel, Ray(spawn_position(surface.point, is_front), 0.0, to_sun, EVERYWHERE));
    vec3 color = 0.5 + 0.4 * cos(vec3(0.0, 1.4, 2.6) + 3.0 * length(surface.point.position));
    float sun = is_lit ? max(dot(normal, to_sun), 0.0) : 0.0;
    return color * (0.25 + 0.15 * normal.y + 0.7 * sun);
}

void main() {
    uint i = global_index();
    if (i >= push.width * push.height) return;
    vec2 at = (vec2(i % push.width, i / push.width) + 0.5 - 0.5 * vec2(push.width, push.height)) / float(push.height);
    vec3 forward = normalize(vec3(-1.0, -0.6, -1.4)), right = normalize(cross(forward, vec3(0, 1, 0)));
    vec3 direction = normalize(forward + 0.75 * (at.x * right - at.y * cross(right, forward)));
    vec3 color = radiance(Ray(-3.4 * forward, 0.0, direction, EVERYWHERE));
    uvec3 bytes = uvec3(255.0 * pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2)) + 0.5);
    AT(push.pixels, i) = bytes.r | (bytes.g << 8) | (bytes.b << 16);
}
