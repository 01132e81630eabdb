// SPDX-License-Identifier: MIT
// The same for float64, in a module of its own: not every device has it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "twinray/glsl/common.glsl"
#include "shaders/verify/float_probe.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { Float64Args args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    FloatCase c = AT(args.cases, i);
    precise double product = double(c.a) * double(c.b);
    precise double sum = double(c.a) + double(c.b);
    AT(args.products, i) = unpackDouble2x32(product);
    AT(args.sums, i) = unpackDouble2x32(sum);
}
