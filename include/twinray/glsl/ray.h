// SPDX-License-Identifier: MIT
// Ray and Hit: the same 32 bytes on the host, on the GPU, in files and for both accelerators.
#ifndef TWINRAY_RAY_H
#define TWINRAY_RAY_H

// The ray covers the points origin + t * direction with t_min < t < t_max. direction need not be normalised.
struct Ray {
    vec3 origin;
    float t_min;  // >= 0; a negative value counts as 0
    vec3 direction;
    float t_max;  // may be +infinity
};
BUFFER_OF(Ray, 8);

// The hit of a ray. The point is (1-u-v) v0 + u v1 + v v2. A miss has hit = 0, t = -1 and zeros.
struct Hit {
    uint hit;              // 0 or 1
    float t;               // in units of the ray's direction
    uint primitive_index;  // position in the mesh's triangle list, including degenerate ones
    uint custom_index;     // the instance's 24-bit index given by the user
    float u;
    float v;
    uint instance_index;  // position in the accelerator's instance array
    uint flags;           // HIT_FRONT or 0
};
BUFFER_OF(Hit, 8);

const uint QUERY_CLOSEST = 0u;  // the smallest t, then the lowest (instance, primitive); HwTlas: the driver breaks ties
const uint QUERY_ANY = 1u;      // whichever hit is found first

// Flags of a trace, with the values of SPIR-V's ray flags.
const uint CULL_BACK = 0x10u;  // triangles seen from behind are not hit
const uint CULL_FRONT = 0x20u;

const uint HIT_FRONT = 1u;  // of a hit: on a triangle's front, by the rules of culling; boxes have no front
#endif
