// SPDX-License-Identifier: MIT
// 16-bit numbers: IEEE 754 binary16.
#ifndef TWINRAY_HALF_H
#define TWINRAY_HALF_H

// Returns the value of an IEEE half.
FUNC float float_of_half(uint bits) {
    uint sign = (bits & 0x8000u) << 16u;
    uint exponent = (bits >> 10u) & 31u;
    uint fraction = bits & 1023u;
    if (exponent == 0u) {
        float tiny = float(fraction) * 5.9604644775390625e-8f;  // 2^-24
        return sign == 0u ? tiny : -tiny;
    }
    uint wide = exponent == 31u ? 255u : exponent + 112u;
    return uintBitsToFloat(sign | (wide << 23u) | (fraction << 13u));
}
#endif
