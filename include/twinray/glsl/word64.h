// SPDX-License-Identifier: MIT
// 64-bit integers as two words, the low one first: not every device has them.
#ifndef TWINRAY_WORD64_H
#define TWINRAY_WORD64_H

// Returns a + b modulo 2^64.
FUNC uvec2 add64(uvec2 a, uvec2 b) {
    uint low = a.x + b.x;
    return uvec2(low, a.y + b.y + (low < a.x ? 1u : 0u));
}
// Returns -a in two's complement.
FUNC uvec2 negate64(uvec2 a) { return add64(uvec2(~a.x, ~a.y), uvec2(1u, 0u)); }

// Returns a * 2^bits modulo 2^64; bits is below 64.
FUNC uvec2 shift_up64(uvec2 a, uint bits) {
    if (bits == 0u) return a;
    return bits < 32u ? uvec2(a.x << bits, a.y << bits | a.x >> (32u - bits)) : uvec2(0u, a.x << (bits - 32u));
}
// Returns a / 2^bits, rounded down; bits is below 64.
FUNC uvec2 shift_down64(uvec2 a, uint bits) {
    if (bits == 0u) return a;
    return bits < 32u ? uvec2(a.x >> bits | a.y << (32u - bits), a.y >> bits) : uvec2(a.y >> (bits - 32u), 0u);
}

// Returns all 64 bits of the product.
FUNC uvec2 multiply64(uint a, uint b) {
    uint high = 0u;
    uint low = 0u;
    umulExtended(a, b, high, low);
    return uvec2(low, high);
}

// Returns whether a < b, both unsigned.
FUNC bool less64(uvec2 a, uvec2 b) { return a.y < b.y || (a.y == b.y && a.x < b.x); }
#endif
