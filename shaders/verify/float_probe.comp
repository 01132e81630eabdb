// SPDX-License-Identifier: MIT
// Performs the arithmetic that the robust levels rely on, on this device; that of float64 in a module of its own, as
// not every device has it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/exact.h"
#include "shaders/verify/float_probe.h"
layout(local_size_x = 64) in;

#ifdef KERNEL_FLOAT_PROBE
layout(push_constant, scalar) uniform Push { FloatProbeArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    FloatCase c = AT(args.cases, i);
    FloatAnswer answer;
    precise float product = c.a * c.b;
    precise float sum = c.a + c.b;
    precise float quotient = c.a / c.b;
    precise float residual = c.a * c.b - c.product;
    answer.product = product;
    answer.sum = sum;
    answer.quotient = quotient;
    answer.square_root = sqrt(abs(c.a));
    answer.inverse_square_root = inversesqrt(abs(c.a));
    answer.precise_residual = residual;
    answer.plain_residual = c.a * c.b - c.product;
    answer.fma_residual = fma(c.a, c.b, -c.product);
    answer.error_free = product_error(c.a, c.b, c.product);
    answer.minimum = min(c.a, c.b);
    answer.maximum = max(c.a, c.b);
    answer.comparisons =
        (c.a < c.b ? 1u : 0u) | (c.a > c.b ? 2u : 0u) | (c.a == c.b ? 4u : 0u) | (!(c.a > c.b) ? 8u : 0u);
    AT(args.answers, i) = answer;
}
#endif

#ifdef KERNEL_FLOAT_PROBE64
layout(push_constant, scalar) uniform Push { Float64Args args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    FloatCase c = AT(args.cases, i);
    precise double product = double(c.a) * double(c.b);
    precise double sum = double(c.a) + double(c.b);
    AT(args.products, i) = unpackDouble2x32(product);
    AT(args.sums, i) = unpackDouble2x32(sum);
}
#endif
