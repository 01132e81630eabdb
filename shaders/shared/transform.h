// SPDX-License-Identifier: MIT
// Affine 3x4 row-major maps: rows r with point' = (dot(r0, (p,1)), dot(r1, (p,1)), dot(r2, (p,1))).
#ifndef TWINRAY_SHARED_TRANSFORM_H
#define TWINRAY_SHARED_TRANSFORM_H
#include "shaders/shared/exact.h"

struct Rows
{
    vec4 r0;
    vec4 r1;
    vec4 r2;
};

FUNC float row_vector(vec4 row, vec3 v)
{
    PRECISE float x = row.x * v.x;
    PRECISE float y = row.y * v.y;
    PRECISE float z = row.z * v.z;
    PRECISE float sum = x + y;
    sum = sum + z;
    return sum;
}

FUNC float row_point(vec4 row, vec3 p)
{
    PRECISE float sum = row_vector(row, p);
    sum = sum + row.w;
    return sum;
}

FUNC vec3 transform_vector(Rows m, vec3 v) { return vec3(row_vector(m.r0, v), row_vector(m.r1, v), row_vector(m.r2, v)); }
FUNC vec3 transform_point(Rows m, vec3 p) { return vec3(row_point(m.r0, p), row_point(m.r1, p), row_point(m.r2, p)); }

// The largest power of two that is not above a positive float (0 for denormals).
FUNC float power_of_two_below(float largest)
{
    return uintBitsToFloat(floatBitsToUint(largest) & 0x7f800000u);
}

FUNC vec3 cross_precise(vec3 a, vec3 b)
{
    PRECISE float xp = a.y * b.z;
    PRECISE float xq = a.z * b.y;
    PRECISE float yp = a.z * b.x;
    PRECISE float yq = a.x * b.z;
    PRECISE float zp = a.x * b.y;
    PRECISE float zq = a.y * b.x;
    PRECISE vec3 result = vec3(xp - xq, yp - yq, zp - zq);
    return result;
}

FUNC float largest_entry(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// The inverse of an invertible map. The linear part is the adjugate refined by one Newton step whose residual is
// evaluated in doubled precision, so that its error is about one rounding for all but nearly singular maps
// (Higham, "Accuracy and Stability of Numerical Algorithms", 2nd ed., 14.1).
FUNC Rows inverse_of(Rows m)
{
    float scale = power_of_two_below(max(largest_entry(vec3(m.r0.x, m.r0.y, m.r0.z)),
                                         max(largest_entry(vec3(m.r1.x, m.r1.y, m.r1.z)),
                                             largest_entry(vec3(m.r2.x, m.r2.y, m.r2.z)))));
    vec3 a0 = vec3(m.r0.x, m.r0.y, m.r0.z) / scale;
    vec3 a1 = vec3(m.r1.x, m.r1.y, m.r1.z) / scale;
    vec3 a2 = vec3(m.r2.x, m.r2.y, m.r2.z) / scale;
    // Columns of the inverse.
    vec3 c0 = cross_precise(a1, a2);
    vec3 c1 = cross_precise(a2, a0);
    vec3 c2 = cross_precise(a0, a1);
    PRECISE float det = accurate_dot(a0, c0, 0.0f);
    c0 = c0 / det;
    c1 = c1 / det;
    c2 = c2 / det;
    // Newton: X += X (I - A X), column by column of the residual.
    vec3 residual0 = vec3(-accurate_dot(a0, c0, -1.0f), -accurate_dot(a1, c0, 0.0f), -accurate_dot(a2, c0, 0.0f));
    vec3 residual1 = vec3(-accurate_dot(a0, c1, 0.0f), -accurate_dot(a1, c1, -1.0f), -accurate_dot(a2, c1, 0.0f));
    vec3 residual2 = vec3(-accurate_dot(a0, c2, 0.0f), -accurate_dot(a1, c2, 0.0f), -accurate_dot(a2, c2, -1.0f));
    PRECISE vec3 x0 = c0 + (c0 * residual0.x + c1 * residual0.y + c2 * residual0.z);
    PRECISE vec3 x1 = c1 + (c0 * residual1.x + c1 * residual1.y + c2 * residual1.z);
    PRECISE vec3 x2 = c2 + (c0 * residual2.x + c1 * residual2.y + c2 * residual2.z);
    x0 = x0 / scale;
    x1 = x1 / scale;
    x2 = x2 / scale;
    vec3 offset = vec3(m.r0.w, m.r1.w, m.r2.w);
    Rows w;
    w.r0 = vec4(x0.x, x1.x, x2.x, -accurate_dot(vec3(x0.x, x1.x, x2.x), offset, 0.0f));
    w.r1 = vec4(x0.y, x1.y, x2.y, -accurate_dot(vec3(x0.y, x1.y, x2.y), offset, 0.0f));
    w.r2 = vec4(x0.z, x1.z, x2.z, -accurate_dot(vec3(x0.z, x1.z, x2.z), offset, 0.0f));
    return w;
}
#endif
