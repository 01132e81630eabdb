// SPDX-License-Identifier: MIT
// The arguments and results of the probe of a device's float arithmetic.
#ifndef TWINRAY_VERIFY_FLOAT_PROBE_H
#define TWINRAY_VERIFY_FLOAT_PROBE_H

struct FloatCase {
    float a;
    float b;
    float product;  // a b, correctly rounded
};
BUFFER_OF(FloatCase, 4);

// The device's results for a case.
struct FloatAnswer {
    float product;
    float sum;
    float quotient;
    float square_root;          // of |a|
    float inverse_square_root;  // of |a|
    float precise_residual;     // a b - product, `precise`: 0 unless contracted all the same
    float plain_residual;       // the same, as the compiler chooses
    float fma_residual;         // by fma(): the rounding error of the product if it is fused
    float error_free;           // by product_error
    float minimum;
    float maximum;
    uint comparisons;  // bits: a < b, a > b, a == b, !(a > b)
};
BUFFER_OF(FloatAnswer, 4);

struct FloatProbeArgs {
    REF(FloatCase) cases;
    REF(FloatAnswer) answers;
    uint count;
    uint reserved;
};

// The arguments for devices with float64.
struct Float64Args {
    REF(FloatCase) cases;
    Uvec2s products;  // double(a) double(b)
    Uvec2s sums;      // double(a) + double(b)
    uint count;
    uint reserved;
};
#endif
