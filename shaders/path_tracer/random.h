// SPDX-License-Identifier: MIT
// Random numbers as a pure function of (pixel, sample, dimension, seed): integers only, so every device and the host
// get the same ones.
#ifndef TWINRAY_PATH_TRACER_RANDOM_H
#define TWINRAY_PATH_TRACER_RANDOM_H

// pcg4d of Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
FUNC uvec4 random_words(uint pixel, uint sample_index, uint dimension, uint seed)
{
    uvec4 v = uvec4(pixel, sample_index, dimension, seed) * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// In [0, 1), a multiple of 2^-24.
FUNC float unit_float(uint word) { return float(word >> 8u) * 5.9604644775390625e-08f; }
FUNC vec2 unit_floats(uint a, uint b) { return vec2(unit_float(a), unit_float(b)); }
#endif
