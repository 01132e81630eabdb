// SPDX-License-Identifier: MIT
// Random numbers as a pure function of (pixel, sample, dimension, seed): integers only, so that every device and the
// host get the same ones.
#ifndef TWINRAY_RANDOM_H
#define TWINRAY_RANDOM_H

// pcg4d of Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020. Its low bits are correlated by up to 0.2
// between neighbouring keys, and Owen's scrambling makes them the first of a number: the last step mixes the high ones
// in.
FUNC uvec4 random_words(uvec4 key) {
    uvec4 v = key * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v ^ (v >> 16u);
}

// Returns a random permutation in which each bit is flipped depending on the lower bits: Owen's scrambling of a number
// in reversed bit order (Laine and Karras 2011, constants of Burley 2020).
FUNC uint scrambled(uint x, uint seed) {
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

// Returns the second dimension of the Sobol sequence in reversed bit order; the first is the index itself. The matrix
// is Pascal's triangle modulo 2, which consists of four copies of its half: five steps instead of 32.
FUNC uint sobol_second(uint index) {
    index ^= index >> 16u;
    index ^= (index & 0xff00ff00u) >> 8u;
    index ^= (index & 0xf0f0f0f0u) >> 4u;
    index ^= (index & 0xccccccccu) >> 2u;
    index ^= (index & 0xaaaaaaaau) >> 1u;
    return index;
}

// Returns point `sample_index` of an Owen-scrambled, shuffled Sobol sequence in two dimensions, as 32-bit fractions.
// Each (pixel, dimension, seed) has a sequence of its own (Burley, "Practical Hash-based Owen Scrambling", 2020): any
// aligned 2^k samples are stratified, and the error of the mean falls faster than with independent numbers.
FUNC uvec2 sample_pair(uint pixel, uint sample_index, uint dimension, uint seed) {
    uvec4 seeds = random_words(uvec4(pixel, dimension, seed, 0u));
    uint index = bitfieldReverse(scrambled(bitfieldReverse(sample_index), seeds.x));
    return uvec2(bitfieldReverse(scrambled(index, seeds.y)), bitfieldReverse(scrambled(sobol_second(index), seeds.z)));
}

// Returns a number in [0, 1), a multiple of 2^-24.
FUNC float unit_float(uint word) { return float(word >> 8u) * 5.9604644775390625e-08f; }
// Returns two numbers in [0, 1), multiples of 2^-24.
FUNC vec2 unit_floats(uvec2 words) { return vec2(unit_float(words.x), unit_float(words.y)); }
#endif
