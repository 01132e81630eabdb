// SPDX-License-Identifier: MIT
// Points in four dimensions that fill the unit cube evenly, and independent random ones.
#ifndef TWINRAY_SOBOL_H
#define TWINRAY_SOBOL_H
#include "twinray/glsl/random.h"

// Returns dimensions three and four of the Sobol sequence as 32-bit fractions, with the direction numbers of Joe and
// Kuo, "Constructing Sobol sequences with better two-dimensional projections", 2008: polynomials x^2 + x + 1 from 1, 3,
// and x^3 + x + 1 from 1, 3, 1. Each direction number follows from the two or three before it.
FUNC uvec2 sobol_third_and_fourth(uint index) {
    uvec2 point = uvec2(0u, 0u);
    uint third = 0x80000000u;
    uint third_next = 0xc0000000u;
    uint fourth = 0x80000000u;
    uint fourth_next = 0xc0000000u;
    uint fourth_after = 0x20000000u;
    for (uint bits = index; bits != 0u; bits = bits >> 1u) {
        point = (bits & 1u) != 0u ? point ^ uvec2(third, fourth) : point;
        uint new_third = third_next ^ third ^ (third >> 2u);
        third = third_next;
        third_next = new_third;
        uint new_fourth = fourth_next ^ fourth ^ (fourth >> 3u);
        fourth = fourth_next;
        fourth_next = fourth_after;
        fourth_after = new_fourth;
    }
    return point;
}

// Returns point `index` of the sequence of `key`, as 32-bit fractions: Owen-scrambled with a seed of its own for each
// dimension and key (Burley, "Practical Hash-based Owen Scrambling", 2020). Keys give independent, unbiased estimates;
// within one, the first 2^k points are stratified.
FUNC uvec4 sobol_point(uvec4 key, uint index) {
    uvec4 seeds = random_words(key);
    uvec2 rest = sobol_third_and_fourth(index);
    return uvec4(bitfieldReverse(scrambled(index, seeds.x)), bitfieldReverse(scrambled(sobol_second(index), seeds.y)),
                 bitfieldReverse(scrambled(bitfieldReverse(rest.x), seeds.z)),
                 bitfieldReverse(scrambled(bitfieldReverse(rest.y), seeds.w)));
}
#endif
