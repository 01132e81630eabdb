// SPDX-License-Identifier: MIT
// Helpers for rays and hits in kernels, besides tracing.
#ifndef TWINRAY_RAYS_H
#define TWINRAY_RAYS_H

#include "twinray/glsl/ray.h"

// Returns the number of rays to trace: `count`, or the number that a kernel has written if that is less.
FUNC uint ray_count(uint count, Uints indirect_count) {
    if (is_absent(indirect_count)) return count;
    uint written = AT(indirect_count, 0);
    return written < count ? written : count;
}

// Returns the result of a ray that hits nothing.
FUNC Hit miss() {
    Hit hit;
    hit.hit = 0u;
    hit.t = -1.0f;
    hit.primitive_index = 0u;
    hit.custom_index = 0u;
    hit.u = 0.0f;
    hit.v = 0.0f;
    hit.instance_index = 0u;
    hit.flags = 0u;
    return hit;
}

// Reads a ray of an array in device memory.
FUNC Ray load_ray(REF(Ray) rays, uint index) { return AT(rays, index); }
// Writes a hit to an array in device memory.
FUNC void store_hit(REF(Hit) hits, uint index, Hit hit) { AT(hits, index) = hit; }

// Bits that are ordered like the largest magnitude of a component, doubled; NaN is above all.
FUNC uint largest_bits(vec3 v) {
    return max(max(floatBitsToUint(v.x) << 1u, floatBitsToUint(v.y) << 1u), floatBitsToUint(v.z) << 1u);
}

const uint INFINITE_BITS = 0xff000000u;  // for largest_bits(): the least value that is not finite
// Returns whether no component is infinite or NaN.
FUNC bool is_finite(vec3 v) { return largest_bits(v) < INFINITE_BITS; }

// Returns whether Vulkan allows the ray. Others (non-finite origin or direction, zero direction, NaN or empty interval)
// miss.
FUNC bool is_traceable(Ray ray) {
    bool moves = ray.direction.x != 0.0f || ray.direction.y != 0.0f || ray.direction.z != 0.0f;
    bool is_bounded = max(largest_bits(ray.origin), largest_bits(ray.direction)) < INFINITE_BITS;
    return moves && is_bounded && ray.t_min < ray.t_max && 0.0f < ray.t_max;
}
#endif
