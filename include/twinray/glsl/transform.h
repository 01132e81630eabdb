// SPDX-License-Identifier: MIT
// Affine 3x4 row-major maps: rows r with point' = (dot(r0, (p,1)), dot(r1, (p,1)), dot(r2, (p,1))).
#ifndef TWINRAY_TRANSFORM_H
#define TWINRAY_TRANSFORM_H
#include "twinray/glsl/exact.h"

// The rows of a map.
struct Rows {
    vec4 r0;
    vec4 r1;
    vec4 r2;
};

// Returns one coordinate of the image of a vector, which has no position: the row without its offset. Products and sums
// round in this order on every device.
FUNC float row_vector(vec4 row, vec3 v) {
    PRECISE float x = row.x * v.x;
    PRECISE float y = row.y * v.y;
    PRECISE float z = row.z * v.z;
    PRECISE float sum = x + y;
    sum = sum + z;
    return sum;
}

// The same for a point.
FUNC float row_point(vec4 row, vec3 p) {
    PRECISE float sum = row_vector(row, p);
    sum = sum + row.w;
    return sum;
}

// Returns the image of a vector: m without its offset.
FUNC vec3 transform_vector(Rows m, vec3 v) {
    return vec3(row_vector(m.r0, v), row_vector(m.r1, v), row_vector(m.r2, v));
}
// Returns the image of a point.
FUNC vec3 transform_point(Rows m, vec3 p) { return vec3(row_point(m.r0, p), row_point(m.r1, p), row_point(m.r2, p)); }

// Returns the largest power of two that is not above a positive float (0 for denormals).
FUNC float power_of_two_below(float largest) { return uintBitsToFloat(floatBitsToUint(largest) & 0x7f800000u); }

// Returns a x b, whose products and differences each round once on every device.
FUNC vec3 cross_precise(vec3 a, vec3 b) {
    PRECISE float xp = a.y * b.z;
    PRECISE float xq = a.z * b.y;
    PRECISE float yp = a.z * b.x;
    PRECISE float yq = a.x * b.z;
    PRECISE float zp = a.x * b.y;
    PRECISE float zq = a.y * b.x;
    PRECISE vec3 result = vec3(xp - xq, yp - yq, zp - zq);
    return result;
}

// Returns a x b in doubled precision.
FUNC vec3 doubled_cross(vec3 a, vec3 b, INOUT(vec3) missing) {
    float x_low = 0.0f;
    float y_low = 0.0f;
    float z_low = 0.0f;
    float x = doubled_difference(a.y, b.z, a.z, b.y, x_low);
    float y = doubled_difference(a.z, b.x, a.x, b.z, y_low);
    float z = doubled_difference(a.x, b.y, a.y, b.x, z_low);
    missing = vec3(x_low, y_low, z_low);
    return vec3(x, y, z);
}

// Returns b if either is NaN, for which max() promises nothing; drivers on CPUs would be slower with max().
FUNC float max_by_comparison(float a, float b) { return a > b ? a : b; }
// Returns the largest magnitude of the components, none of which is NaN.
FUNC float largest_entry(vec3 v) { return max_by_comparison(abs(v.x), max_by_comparison(abs(v.y), abs(v.z))); }
// Returns the largest magnitude of a coordinate of a box.
FUNC float largest_coordinate(vec3 lo, vec3 hi) { return max_by_comparison(largest_entry(lo), largest_entry(hi)); }

// Returns the inverse of an invertible map: cofactors over the determinant, both in doubled precision, so that each
// entry of the linear part is right to a few roundings of itself for condition numbers up to about 10^7. Columns and
// rows are scaled by powers of two first, which is exact, so that products neither overflow nor vanish: scales along
// axes, of any size, may come before a rotation, and after one (then entries are right to 2^-15 of the largest in their
// column). The result is not finite if a column or row is 0 or denormal.
FUNC Rows inverse_of(Rows m) {
    vec3 a0 = vec3(m.r0.x, m.r0.y, m.r0.z);
    vec3 a1 = vec3(m.r1.x, m.r1.y, m.r1.z);
    vec3 a2 = vec3(m.r2.x, m.r2.y, m.r2.z);
    vec3 t = vec3(power_of_two_below(largest_entry(vec3(a0.x, a1.x, a2.x))),
                  power_of_two_below(largest_entry(vec3(a0.y, a1.y, a2.y))),
                  power_of_two_below(largest_entry(vec3(a0.z, a1.z, a2.z))));
    a0 = a0 / t;
    a1 = a1 / t;
    a2 = a2 / t;
    float s0 = power_of_two_below(largest_entry(a0));
    float s1 = power_of_two_below(largest_entry(a1));
    float s2 = power_of_two_below(largest_entry(a2));
    a0 = a0 / s0;
    a1 = a1 / s1;
    a2 = a2 / s2;
    // The columns of the adjugate.
    vec3 low0 = vec3(0.0f);
    vec3 low1 = vec3(0.0f);
    vec3 low2 = vec3(0.0f);
    vec3 c0 = doubled_cross(a1, a2, low0);
    vec3 c1 = doubled_cross(a2, a0, low1);
    vec3 c2 = doubled_cross(a0, a1, low2);
    float missing = 0.0f;
    float missing_size = 0.0f;
    PRECISE float det = doubled_dot(a0, c0, 0.0f, missing, missing_size);
    det = det + (missing + accurate_dot(a0, low0, 0.0f));
    PRECISE vec3 x0 = (c0 + low0) / det / s0 / t;
    PRECISE vec3 x1 = (c1 + low1) / det / s1 / t;
    PRECISE vec3 x2 = (c2 + low2) / det / s2 / t;
    vec3 offset = vec3(m.r0.w, m.r1.w, m.r2.w);
    Rows w;
    w.r0 = vec4(x0.x, x1.x, x2.x, -accurate_dot(vec3(x0.x, x1.x, x2.x), offset, 0.0f));
    w.r1 = vec4(x0.y, x1.y, x2.y, -accurate_dot(vec3(x0.y, x1.y, x2.y), offset, 0.0f));
    w.r2 = vec4(x0.z, x1.z, x2.z, -accurate_dot(vec3(x0.z, x1.z, x2.z), offset, 0.0f));
    return w;
}
#endif
