// SPDX-License-Identifier: MIT
// Float64 arithmetic whose roundings are known: `precise` in every helper, as in exact.h.
#ifndef TWINRAY_SHARED_EXACT_DOUBLE_H
#define TWINRAY_SHARED_EXACT_DOUBLE_H

// The same number, of denormals too, which a device's conversion may flush.
FUNC double widened(float x) {
    const double LEAST = double(7.8886090522101181e-31f) * double(1.7763568394002505e-15f);  // 2^-149
    uint bits = floatBitsToUint(x);
    if ((bits & 0x7f800000u) != 0u) return double(x);
    PRECISE double magnitude = double(bits & 0x7fffffu) * LEAST;
    return bits >> 31u != 0u ? -magnitude : magnitude;
}

FUNC double product_sum(dvec3 a, dvec3 b) {
    PRECISE double x = a.x * b.x;
    PRECISE double y = a.y * b.y;
    PRECISE double z = a.z * b.z;
    PRECISE double sum = x + y;
    sum = sum + z;
    return sum;
}

FUNC dvec3 cross_product(dvec3 a, dvec3 b) {
    PRECISE double x = a.y * b.z - a.z * b.y;
    PRECISE double y = a.z * b.x - a.x * b.z;
    PRECISE double z = a.x * b.y - a.y * b.x;
    return dvec3(x, y, z);
}

// Returns the rounding error of a product in float64, as product_error in exact.h.
FUNC double product_error_double(double a, double b, double p) {
    const double SPLITTER = double(134217729u);  // 2^27 + 1
    PRECISE double a_scaled = SPLITTER * a;
    PRECISE double a_rest = a_scaled - a;
    PRECISE double a_high = a_scaled - a_rest;
    PRECISE double a_low = a - a_high;
    PRECISE double b_scaled = SPLITTER * b;
    PRECISE double b_rest = b_scaled - b;
    PRECISE double b_high = b_scaled - b_rest;
    PRECISE double b_low = b - b_high;
    PRECISE double high_high = a_high * b_high;
    PRECISE double high_low = a_high * b_low;
    PRECISE double low_high = a_low * b_high;
    PRECISE double low_low = a_low * b_low;
    PRECISE double error = high_high - p;
    error = error + high_low;
    error = error + low_high;
    error = error + low_low;
    return error;
}

// Uses Veltkamp's splitting. Compilers may take double(float(x)) for x: conversions cannot be `precise`.
FUNC double rounded_to_24_bits(double x) {
    PRECISE double scaled = double(536870913u) * x;  // 2^29 + 1
    PRECISE double rest = scaled - x;
    PRECISE double high = scaled - rest;
    return high;
}
#endif
