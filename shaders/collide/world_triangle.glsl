// SPDX-License-Identifier: MIT
// The common beginning of kernels over triangles in world space, in float64: the triangle and the certain signs.
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/orient.h"

struct WorldTriangle {
    dvec3 a;
    dvec3 b;
    dvec3 c;
};

int volume_sign(dvec3 a, dvec3 b, dvec3 c, dvec3 d) { return filtered_volume_sign(a, b, c, d); }
int area_sign(dvec3 a, dvec3 b, dvec3 c, uint axis) { return filtered_area_sign(a, b, c, axis); }
