// SPDX-License-Identifier: MIT
// Error-free float transformations. Every helper repeats `precise`: it does not reach into callees, and a contracted
// product would break both the exactness here and the watertightness that depends on it.
#ifndef TWINRAY_EXACT_H
#define TWINRAY_EXACT_H

const float HALF_ULP = 5.9604644775390625e-08f;  // u = 2^-24, the unit roundoff of float32

// Returns the number with only the first 12 bits of its significand. The remainder has 12 too, so that products of two
// parts are exact.
FUNC float high_part(float x) { return uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u); }

// Returns the rounding error of the product p = fl(a b): a b = p + error, exactly, barring over- and underflow. Dekker,
// "A floating-point technique for extending the available precision", 1971, but numbers are split by cutting, not by
// rounding.
FUNC float product_error(float a, float b, float p) {
    PRECISE float error = 0.0f;
    if (FUSED_FMA) {
        error = FUSED(a, b, -p);
    } else {
        float a_high = high_part(a);
        float b_high = high_part(b);
        PRECISE float a_low = a - a_high;
        PRECISE float b_low = b - b_high;
        PRECISE float high_high = a_high * b_high;
        PRECISE float high_low = a_high * b_low;
        PRECISE float low_high = a_low * b_high;
        PRECISE float low_low = a_low * b_low;
        error = high_high - p;
        error = error + high_low;
        error = error + low_high;
        error = error + low_low;
    }
    return error;
}

// Returns the rounding error of the sum s = fl(a + b): a + b = s + error, exactly (Knuth's TwoSum).
FUNC float sum_error(float a, float b, float s) {
    PRECISE float b_virtual = s - a;
    PRECISE float a_virtual = s - b_virtual;
    PRECISE float b_error = b - b_virtual;
    PRECISE float a_error = a - a_virtual;
    PRECISE float error = a_error + b_error;
    return error;
}

// Computes p - q in doubled precision for products p = a b and q = c d: returns the difference; `missing` is its error.
FUNC float doubled_difference(float a, float b, float c, float d, INOUT(float) missing) {
    PRECISE float p = a * b;
    PRECISE float q = c * d;
    PRECISE float difference = p - q;
    PRECISE float low = product_error(a, b, p) - product_error(c, d, q);
    low = low + sum_error(p, -q, difference);
    missing = low;
    return difference;
}

// Computes a.x b.x + a.y b.y + a.z b.z + c in doubled precision (Ogita, Rump, Oishi, "Accurate sum and dot product",
// 2005): returns the sum rounded to float32. `missing` is the rest, and `missing_size` the sum of the magnitudes of its
// terms: the rest is off by five roundings of that.
FUNC float doubled_dot(vec3 a, vec3 b, float c, INOUT(float) missing, INOUT(float) missing_size) {
    PRECISE float p0 = a.x * b.x;
    PRECISE float p1 = a.y * b.y;
    PRECISE float p2 = a.z * b.z;
    PRECISE float s0 = c + p0;
    PRECISE float s1 = s0 + p1;
    PRECISE float s2 = s1 + p2;
    float e0 = sum_error(c, p0, s0);
    float e1 = product_error(a.x, b.x, p0);
    float e2 = sum_error(s0, p1, s1);
    float e3 = product_error(a.y, b.y, p1);
    float e4 = sum_error(s1, p2, s2);
    float e5 = product_error(a.z, b.z, p2);
    PRECISE float low = e0 + e1;
    low = low + e2;
    low = low + e3;
    low = low + e4;
    low = low + e5;
    missing = low;
    PRECISE float size = abs(e0) + abs(e1) + abs(e2) + abs(e3) + abs(e4) + abs(e5);
    missing_size = size;
    return s2;
}

// The same, rounded once; the plain sum if a part overflows.
FUNC float accurate_dot(vec3 a, vec3 b, float c) {
    float missing = 0.0f;
    float missing_size = 0.0f;
    PRECISE float sum = doubled_dot(a, b, c, missing, missing_size);
    PRECISE float result = sum + missing;
    return abs(missing) < uintBitsToFloat(0x7f800000u) ? result : sum;
}
#endif
