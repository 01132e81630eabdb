// SPDX-License-Identifier: MIT
// Decides which triangles can be hit at all: those with finite vertices that span an area. The decision is exact: three
// distinct vertices on a line would otherwise be hit now and then, because a sheared image of them is not quite on a
// line.
#ifndef TWINRAY_TRIANGLE_H
#define TWINRAY_TRIANGLE_H
#include "twinray/glsl/exact.h"
#include "twinray/glsl/rays.h"
#include "twinray/glsl/transform.h"

// Returns whether 12 floats sum to 0, exactly: they are added one by one to an expansion, a sum of floats that do not
// overlap, which is 0 only if all of them are (Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997, theorem
// 10).
FUNC bool sums_to_zero(float terms[12]) {
    float expansion[12];
    for (uint i = 0u; i < 12u; i = i + 1u) {
        float carry = terms[i];
        for (uint j = 0u; j < i; j = j + 1u) {
            PRECISE float sum = carry + expansion[j];
            expansion[j] = sum_error(carry, expansion[j], sum);
            carry = sum;
        }
        expansion[i] = carry;
    }
    bool zero = true;
    for (uint k = 0u; k < 12u; k = k + 1u) zero = zero && expansion[k] == 0.0f;
    return zero;
}

// Returns whether (b - a) x (c - a) = 0 for points of the plane: the six products and their rounding errors cancel.
FUNC bool is_flat(vec2 a, vec2 b, vec2 c) {
    float terms[12];
    PRECISE float bc = b.x * c.y;
    PRECISE float ba = b.x * a.y;
    PRECISE float ac = a.x * c.y;
    PRECISE float cb = b.y * c.x;
    PRECISE float ab = b.y * a.x;
    PRECISE float ca = a.y * c.x;
    terms[0] = product_error(b.x, c.y, bc);
    terms[1] = -product_error(b.x, a.y, ba);
    terms[2] = -product_error(a.x, c.y, ac);
    terms[3] = -product_error(b.y, c.x, cb);
    terms[4] = product_error(b.y, a.x, ab);
    terms[5] = product_error(a.y, c.x, ca);
    terms[6] = bc;
    terms[7] = -ba;
    terms[8] = -ac;
    terms[9] = -cb;
    terms[10] = ab;
    terms[11] = ca;
    return sums_to_zero(terms);
}

// Returns whether p - q is surely not 0 despite rounding, for products p and q of rounded differences: 8 roundings of
// 2^-24.
FUNC bool is_surely_not_zero(float p, float q) {
    PRECISE float difference = p - q;
    PRECISE float size = abs(p) + abs(q);
    return abs(difference) > size * 4.76837158203125e-07f;
}

// Returns whether no coordinate is infinite or NaN.
FUNC bool is_finite_triangle(vec3 a, vec3 b, vec3 c) { return is_finite(a) && is_finite(b) && is_finite(c); }

// Returns 0 for a denormal coordinate, decided by its bits, so that devices agree whether or not they flush denormals.
FUNC float flushed(float x) { return (floatBitsToUint(x) & 0x7f800000u) == 0u ? 0.0f : x; }
// The same for each coordinate.
FUNC vec3 flushed_point(vec3 p) { return vec3(flushed(p.x), flushed(p.y), flushed(p.z)); }

// Returns whether the triangle can be hit: its vertices are finite and exactly not on one line; denormal coordinates
// count as 0.
FUNC bool is_active_triangle(vec3 a, vec3 b, vec3 c) {
    if (!is_finite_triangle(a, b, c)) return false;
    a = flushed_point(a);
    b = flushed_point(b);
    c = flushed_point(c);
    PRECISE vec3 u = b - a;
    PRECISE vec3 v = c - a;
    if (is_surely_not_zero(u.x * v.y, u.y * v.x) || is_surely_not_zero(u.y * v.z, u.z * v.y) ||
        is_surely_not_zero(u.z * v.x, u.x * v.z))
        return true;
    // Scales by a power of two, which is exact, so that the products neither overflow nor vanish.
    float largest = max(largest_entry(a), max(largest_entry(b), largest_entry(c)));
    if (largest == 0.0f) return false;
    float scale = power_of_two_below(largest);
    a = a / scale;
    b = b / scale;
    c = c / scale;
    bool flat_so_far = true;
    DONT_UNROLL for (uint axis = 0u; axis < 3u; axis = axis + 1u) {
        flat_so_far = flat_so_far && is_flat(vec2(a.x, a.y), vec2(b.x, b.y), vec2(c.x, c.y));
        a = vec3(a.y, a.z, a.x);
        b = vec3(b.y, b.z, b.x);
        c = vec3(c.y, c.z, c.x);
    }
    return !flat_so_far;
}

// Reads 3 tightly packed floats per vertex.
FUNC vec3 load_position(Floats positions, uint vertex) { return AT(Vec3s(positions.address), vertex); }

// Reads 3 tightly packed indices per triangle.
FUNC uvec3 load_indices(Uints indices, uint triangle) { return AT(Uvec3s(indices.address), triangle); }
#endif
