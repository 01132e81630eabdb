// SPDX-License-Identifier: MIT
// Integers of 64 bits as two words, the low one first: not every device has them.
#ifndef TWINRAY_WORD64_H
#define TWINRAY_WORD64_H

FUNC uvec2 add64(uvec2 a, uvec2 b) {
    uint low = a.x + b.x;
    return uvec2(low, a.y + b.y + (low < a.x ? 1u : 0u));
}
// In two's complement.
FUNC uvec2 negate64(uvec2 a) { return add64(uvec2(~a.x, ~a.y), uvec2(1u, 0u)); }

// By fewer than 64 bits.
FUNC uvec2 shift_up64(uvec2 a, uint bits) {
    if (bits == 0u) return a;
    return bits < 32u ? uvec2(a.x << bits, a.y << bits | a.x >> (32u - bits)) : uvec2(0u, a.x << (bits - 32u));
}
FUNC uvec2 shift_down64(uvec2 a, uint bits) {
    if (bits == 0u) return a;
    return bits < 32u ? uvec2(a.x >> bits | a.y << (32u - bits), a.y >> bits) : uvec2(a.y >> (bits - 32u), 0u);
}

FUNC uvec2 multiply64(uint a, uint b) {
    uint high = 0u;
    uint low = 0u;
    umulExtended(a, b, high, low);
    return uvec2(low, high);
}

// Without a sign.
FUNC bool less64(uvec2 a, uvec2 b) { return a.y < b.y || (a.y == b.y && a.x < b.x); }
#endif
