// SPDX-License-Identifier: MIT
// What kernels do with rays and hits besides tracing them.
#ifndef TWINRAY_RAYS_H
#define TWINRAY_RAYS_H

#include "twinray/glsl/ray.h"

// How many rays to trace: `count`, or what a kernel has written if that is less.
FUNC uint ray_count(uint count, Uints indirect_count) {
    if (is_absent(indirect_count)) return count;
    uint written = AT(indirect_count, 0);
    return written < count ? written : count;
}

// What a ray that meets nothing gets.
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

// Of an array in device memory.
FUNC Ray load_ray(REF(Ray) rays, uint index) { return AT(rays, index); }
// Likewise.
FUNC void store_hit(REF(Hit) hits, uint index, Hit hit) { AT(hits, index) = hit; }

// The magnitudes' bits, doubled, which are in the order of the magnitudes, NaN above all.
FUNC uint largest_bits(vec3 v) {
    return max(max(floatBitsToUint(v.x) << 1u, floatBitsToUint(v.y) << 1u), floatBitsToUint(v.z) << 1u);
}

const uint INFINITE_BITS = 0xff000000u;  // of largest_bits: the least that is not finite
// Neither infinite nor NaN.
FUNC bool is_finite(vec3 v) { return largest_bits(v) < INFINITE_BITS; }

// Rays that Vulkan forbids (non-finite origin or direction, zero direction, NaN or empty interval) miss.
FUNC bool is_traceable(Ray ray) {
    bool moves = ray.direction.x != 0.0f || ray.direction.y != 0.0f || ray.direction.z != 0.0f;
    bool is_bounded = max(largest_bits(ray.origin), largest_bits(ray.direction)) < INFINITE_BITS;
    return moves && is_bounded && ray.t_min < ray.t_max && 0.0f < ray.t_max;
}
#endif
