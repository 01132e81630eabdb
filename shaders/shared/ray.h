// SPDX-License-Identifier: MIT
// Ray and Hit: the same 32 bytes on the host, on the GPU, in files and for both accelerators.
#ifndef TWINRAY_SHARED_RAY_H
#define TWINRAY_SHARED_RAY_H

// The points origin + t * direction with t_min < t < t_max. direction need not be normalised.
struct Ray
{
    vec3 origin;
    float t_min;      // >= 0; a negative value counts as 0
    vec3 direction;
    float t_max;      // may be +infinity
};
BUFFER_OF(Ray, 8);

// What a ray met. The point is (1-u-v) v0 + u v1 + v v2. A miss has hit = 0, t = -1 and zeros.
struct Hit
{
    uint hit;             // 0 or 1
    float t;              // in units of the ray's direction
    uint primitive_index; // position in the mesh's triangle list, degenerate ones counted
    uint custom_index;    // the instance's 24-bit index given by the user
    float u;
    float v;
    uint instance_index;  // position in the accelerator's instance array
    uint flags;           // 0, kept for later use
};
BUFFER_OF(Hit, 8);

const uint QUERY_CLOSEST = 0u; // the hit with smallest t, then lowest (instance, primitive)
const uint QUERY_ANY = 1u;     // whichever hit is found first

// Flags of a trace, with the values of SPIR-V's ray flags.
const uint CULL_BACK = 0x10u;  // triangles seen from behind are not hit
const uint CULL_FRONT = 0x20u;

// How many rays to trace: `count`, or what a kernel has written if that is less.
FUNC uint ray_count(uint count, Uints indirect_count)
{
    if (is_null(indirect_count)) return count;
    uint written = AT(indirect_count, 0);
    return written < count ? written : count;
}

FUNC Hit miss()
{
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

FUNC Ray load_ray(REF(Ray) rays, uint index) { return AT(rays, index); }
FUNC void store_hit(REF(Hit) hits, uint index, Hit hit) { AT(hits, index) = hit; }

// The magnitudes' bits, doubled, which are in the order of the magnitudes, NaN above all.
FUNC uint largest_bits(vec3 v)
{
    return max(max(floatBitsToUint(v.x) << 1u, floatBitsToUint(v.y) << 1u), floatBitsToUint(v.z) << 1u);
}

const uint INFINITE_BITS = 0xff000000u; // of largest_bits: the least that is not finite
FUNC bool is_finite(vec3 v) { return largest_bits(v) < INFINITE_BITS; }

// Rays that Vulkan forbids (non-finite origin or direction, zero direction, NaN or empty interval) miss.
FUNC bool is_traceable(Ray ray)
{
    bool moves = ray.direction.x != 0.0f || ray.direction.y != 0.0f || ray.direction.z != 0.0f;
    bool is_bounded = max(largest_bits(ray.origin), largest_bits(ray.direction)) < INFINITE_BITS;
    return moves && is_bounded && ray.t_min < ray.t_max && 0.0f < ray.t_max;
}
#endif
