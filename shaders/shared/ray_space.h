// SPDX-License-Identifier: MIT
// Rays prepared for a coordinate space, and ray-box tests that lose none of them.
#ifndef TWINRAY_SHARED_RAY_SPACE_H
#define TWINRAY_SHARED_RAY_SPACE_H
#include "twinray/glsl/rays.h"
#include "twinray/glsl/transform.h"

// A ray prepared for one coordinate space.
//  - Boxes: near and far planes use reciprocals padded by a factor 1 -+ 2^-20, which covers the 2.5 ulp that Vulkan
//    allows a division and the roundings of (plane - origin) * reciprocal (Ize, "Robust BVH Ray Traversal", 2013,
//    with the constant for Vulkan), and origins shifted by an absolute pad for what an instance transform adds.
//    Reciprocals have a limit: across the dominant axis a ray counts as moving by 2^-40 at least of what it moves
//    along it, far less than the pad. So they are finite for directions of any use. Where the distance to what lies in
//    the space is beyond 2^80 in t, or within 2^-40, t of boxes is taken times a power of two, so that no product of
//    a box with them overflows or is denormal.
//  - Triangles: shear constants of Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", 2013.
struct RaySpace {
    vec3 origin;
    vec3 direction;
    vec3 inverse;  // of the direction, within the limit, times t_scale
    float pad;
    float t_scale;  // of t of boxes
    uint axis;      // the dominant axis of the direction
    float shear_x;
    float shear_y;
    float shear_z;
};

// Tests of boxes take this from a RaySpace. Made at each node: carried through the loop it holds 13 registers.
struct BoxRay {
    vec3 near_origin;
    vec3 far_origin;
    vec3 near_inverse;  // times t_scale
    vec3 far_inverse;
    float t_scale;
};

FUNC float reciprocal(float d) {
    // 1/0 is written out: Vulkan leaves the division undefined. It is positive for either zero, because compilers may
    // turn one into the other, and the order of children depends on it.
    return d == 0.0f ? uintBitsToFloat(0x7f800000u) : 1.0f / d;
}

FUNC uint dominant_axis(vec3 direction) {
    vec3 size = abs(direction);
    return size.x >= size.y ? (size.x >= size.z ? 0u : 2u) : (size.y >= size.z ? 1u : 2u);
}

FUNC vec3 dominant_last(vec3 v, uint axis) {
    return axis == 0u ? vec3(v.y, v.z, v.x) : (axis == 1u ? vec3(v.z, v.x, v.y) : v);
}

// Returns x, or the nearest of -limit and limit.
FUNC float within(float x, float limit) { return min_no_nan(max_no_nan(x, -limit), limit); }

FUNC BoxRay box_ray(RaySpace space) {
#ifdef TWINRAY_NO_PADDING  // a negative control: shows why the padding is needed
    const float NEAR_FACTOR = 1.0f;
    const float FAR_FACTOR = 1.0f;
#else
    const float NEAR_FACTOR = 0.99999904632568359375f;  // 1 - 2^-20
    const float FAR_FACTOR = 1.00000095367431640625f;   // 1 + 2^-20
#endif
    vec3 inverse = space.inverse;
    float pad = space.pad;
    PRECISE vec3 near_inverse = inverse * NEAR_FACTOR;
    PRECISE vec3 far_inverse = inverse * FAR_FACTOR;
    // Its signs are those of the near inverse, which tests of boxes read.
    vec3 shift = vec3(near_inverse.x < 0.0f ? -pad : pad, near_inverse.y < 0.0f ? -pad : pad,
                      near_inverse.z < 0.0f ? -pad : pad);
    PRECISE vec3 near_origin = space.origin + shift;
    PRECISE vec3 far_origin = space.origin - shift;
    BoxRay ray;
    ray.near_origin = near_origin;
    ray.far_origin = far_origin;
    ray.near_inverse = near_inverse;
    ray.far_inverse = far_inverse;
    ray.t_scale = space.t_scale;
    return ray;
}

// Returns 1, or the power of two that brings the largest t at which a ray may meet something between 2^-40 and 2^80.
// That is 2^38 pads at most times the reciprocal of the direction's dominant entry.
FUNC float scale_of_reach(float pad, float along) {
    const int LOWEST = -40 - 38;
    const int HIGHEST = 80 - 38;
    int exponent = int(floatBitsToUint(pad) >> 23u) + int(floatBitsToUint(along) >> 23u) - 254;
    int power = min(max(exponent, LOWEST), HIGHEST) - exponent;
    return uintBitsToFloat(uint(min(max(power, -126), 126) + 127) << 23u);
}

// pad: see above; 2^-38 of the coordinates of the origin and of all boxes at least.
FUNC RaySpace make_ray_space(vec3 origin, vec3 direction, float pad) {
#ifdef TWINRAY_NO_PADDING
    pad = 0.0f;
#endif
    const float LARGEST_FLOAT = uintBitsToFloat(0x7f7fffffu);
    const float STEEPEST = 1099511627776.0f;  // 2^40
    RaySpace space;
    space.origin = origin;
    space.direction = direction;
    space.axis = dominant_axis(direction);
    vec3 d = dominant_last(direction, space.axis);
    vec3 inverse = vec3(reciprocal(direction.x), reciprocal(direction.y), reciprocal(direction.z));
    float of_dominant = dominant_last(inverse, space.axis).z;
    float along = abs(of_dominant);
    float limit = STEEPEST * along;
    limit = limit < LARGEST_FLOAT ? limit : LARGEST_FLOAT;
    space.t_scale = scale_of_reach(pad, along);
    inverse = vec3(within(inverse.x, limit), within(inverse.y, limit), within(inverse.z, limit));
    space.inverse = inverse * space.t_scale;
    space.pad = pad;
    space.shear_x = d.x / d.z;
    space.shear_y = d.y / d.z;
    space.shear_z = of_dominant;
    return space;
}

// Returns how far aside of a ray a vertex may be sheared, rounded: 8 of 2^-24 of its distance along an axis. A triangle
// is hit if its sheared vertices say so, and its box must also be hit, however near to the ray's origin that is.
// 2^-20
FUNC float vertex_pad(vec3 origin, float extent) { return (largest_entry(origin) + extent) * 9.5367431640625e-07f; }

// Return the ends of the interval in which a ray is inside of all three slabs, begun with its own, which a NaN (of
// products out of range) leaves as it was.
FUNC float latest_of(float enter, float near_x, float near_y, float near_z) {
    return max_no_nan(near_z, max_no_nan(near_y, max_no_nan(near_x, enter)));
}
FUNC float earliest_of(float leave, float far_x, float far_y, float far_z) {
    return min_no_nan(far_z, min_no_nan(far_y, min_no_nan(far_x, leave)));
}

// Returns the interval in which the ray is inside the box within [t_min, t_max], in t * ray.t_scale: the first is
// greater if it does not meet the box.
FUNC vec2 cross_box(vec3 lo, vec3 hi, BoxRay ray, float t_min, float t_max) {
    bool flip_x = ray.near_inverse.x < 0.0f;
    bool flip_y = ray.near_inverse.y < 0.0f;
    bool flip_z = ray.near_inverse.z < 0.0f;
    PRECISE float near_x = ((flip_x ? hi.x : lo.x) - ray.near_origin.x) * ray.near_inverse.x;
    PRECISE float near_y = ((flip_y ? hi.y : lo.y) - ray.near_origin.y) * ray.near_inverse.y;
    PRECISE float near_z = ((flip_z ? hi.z : lo.z) - ray.near_origin.z) * ray.near_inverse.z;
    PRECISE float far_x = ((flip_x ? lo.x : hi.x) - ray.far_origin.x) * ray.far_inverse.x;
    PRECISE float far_y = ((flip_y ? lo.y : hi.y) - ray.far_origin.y) * ray.far_inverse.y;
    PRECISE float far_z = ((flip_z ? lo.z : hi.z) - ray.far_origin.z) * ray.far_inverse.z;
    PRECISE float first = t_min * ray.t_scale;
    PRECISE float last = t_max * ray.t_scale;
    return vec2(latest_of(first, near_x, near_y, near_z), earliest_of(last, far_x, far_y, far_z));
}

FUNC bool enter_box(vec3 lo, vec3 hi, RaySpace space, float t_min, float t_max, INOUT(float) enter) {
    vec2 crossing = cross_box(lo, hi, box_ray(space), t_min, t_max);
    enter = crossing.x;
    return crossing.x <= crossing.y;
}
#endif
