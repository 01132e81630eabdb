// SPDX-License-Identifier: MIT
// A ball in a cage of wire, above a floor, in the sun: the common part of its kernels and C++.
#ifndef TUTORIALS_CAGE_H
#define TUTORIALS_CAGE_H
#include "twinray/glsl/rays.h"

// The kinds of instances, by their custom index. The mask of each is 1 << that.
const uint FLOOR = 0u;  // at y = -1
const uint CAGE = 1u;   // a sphere of radius 1 about (0, 0, 0)
const uint BALL = 2u;   // another, inside
const uint IN_THE_WAY_OF_LIGHT = (1u << CAGE) | (1u << BALL);

const float BALL_RADIUS = 0.5f;
const float WIRE_WIDTH = 0.09f;  // as a weight of a triangle's corner

struct PictureArgs {
    Address accel;
    Uints pixels;  // red, green, blue from the low byte
    uint size;     // of the picture, in pixels a side
};

FUNC vec3 to_sun() { return vec3(-0.36f, 0.9f, 0.246f); }
FUNC vec3 eye() { return vec3(1.92f, 2.4f, 2.56f); }

FUNC Ray endless_ray(vec3 origin, vec3 direction) {
    Ray ray;
    ray.origin = origin;
    ray.t_min = 0.0f;
    ray.direction = direction;
    ray.t_max = uintBitsToFloat(0x7f800000u);
    return ray;
}

// `reach`: half of the visible width, as a tangent.
FUNC Ray camera_ray(uint pixel, uint size, float reach) {
    vec3 forward = vec3(-0.48f, -0.6f, -0.64f), right = vec3(0.8f, 0.0f, -0.6f), up = vec3(-0.36f, 0.8f, -0.48f);
    float x = reach * (float(2u * (pixel % size) + 1u) / float(size) - 1.0f);
    float y = reach * (1.0f - float(2u * (pixel / size) + 1u) / float(size));
    return endless_ray(eye(), forward + right * x + up * y);
}

// [light]
// Returns the normal on the side that the ray comes from.
FUNC vec3 normal_of(Ray ray, Hit hit) {
    if (hit.custom_index == FLOOR) return vec3(0.0f, 1.0f, 0.0f);
    vec3 outward = normalize(ray.origin + ray.direction * hit.t);
    return dot(outward, ray.direction) < 0.0f ? outward : -outward;
}

// Light leaves the wire beside it, by its thickness. Ball and floor need no such step: the ball is only hit by rays
// that enter it, and the floor is not in the way of light.
FUNC Ray ray_to_sun(Ray ray, Hit hit) {
    vec3 point = ray.origin + ray.direction * hit.t;
    if (hit.custom_index == CAGE) point = point + normal_of(ray, hit) * 0.04f;
    return endless_ray(point, to_sun());
}

FUNC vec3 color_of(Ray ray, Hit hit, bool is_lit) {
    if (hit.hit == 0u) return vec3(1.0f);
    float sun = is_lit ? max(dot(normal_of(ray, hit), to_sun()), 0.0f) : 0.0f;
    vec3 own = hit.custom_index == FLOOR  ? vec3(0.75f, 0.73f, 0.7f)
               : hit.custom_index == CAGE ? vec3(0.25f, 0.3f, 0.4f)
                                          : vec3(0.85f, 0.3f, 0.12f);
    return own * (0.25f + 0.85f * sun);
}
// [/light]
#endif
