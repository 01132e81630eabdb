// SPDX-License-Identifier: MIT
// Watertight ray-triangle tests.
#ifndef TWINRAY_SHARED_INTERSECT_H
#define TWINRAY_SHARED_INTERSECT_H
#include "twinray/glsl/word64.h"
#include "shaders/shared/ray_space.h"

// Returns a vertex seen along the ray: x, y sheared so that the ray is the point (0, 0), z along the dominant axis. It
// depends only on the vertex and the ray, so that all triangles that share the vertex see the same point.
FUNC vec3 sheared(vec3 vertex, RaySpace space) {
    PRECISE vec3 relative = vertex - space.origin;
    vec3 p = dominant_last(relative, space.axis);
    PRECISE float move_x = space.shear_x * p.z;
    PRECISE float move_y = space.shear_y * p.z;
    PRECISE float x = p.x - move_x;
    PRECISE float y = p.y - move_y;
    return vec3(x, y, p.z);
}

// Returns twice the signed area of (0, a, b). Rounding is monotone: a nonzero result has the right sign.
FUNC float edge_function(vec3 a, vec3 b) {
    PRECISE float p = a.x * b.y;
    PRECISE float q = a.y * b.x;
    PRECISE float area = p - q;
#ifdef TWINRAY_CONTRACTED  // a negative control: the result of fma(a.x, b.y, -q), for drivers that do not contract
    PRECISE double fused = double(a.x) * double(b.y) - double(q);
    area = float(fused);
#endif
    return area;
}

// The same, with an error of a rounding or two of the result, while that of edge_function is roundings of its products:
// in slivers they cancel, and the weights of the vertices with them.
FUNC float accurate_edge_function(vec3 a, vec3 b) {
    float missing = 0.0f;
    PRECISE float area = doubled_difference(a.x, b.y, a.y, b.x, missing);
    // The sign must not change, and an overflowed result has no known error.
    if (abs(missing) <= abs(area) || area == 0.0f) area = area + missing;
    return area;
}

// Returns the power of two by which x and y of two sheared vertices may be multiplied, exactly and without overflow of
// a product. If a ray passes a vertex by a denormal distance, the products that decide would underflow, some to 0, and
// triangles around the vertex would disagree. It depends only on the edge, so that both of its triangles see the same.
FUNC float room_above(vec3 a, vec3 b) {
    const float TARGET = 1.152921504606846976e+18f;     // 2^60
    const float MOST = 1.329227995784915872903807e36f;  // 2^120
    float largest = max(max(abs(a.x), abs(a.y)), max(abs(b.x), abs(b.y)));
    PRECISE float to_target = TARGET / power_of_two_below(largest);
    return largest < TARGET / MOST ? MOST : max(to_target, 1.0f);
}

FUNC vec3 scaled_across(vec3 v, float scale) {
    PRECISE float x = v.x * scale;
    PRECISE float y = v.y * scale;
    return vec3(x, y, v.z);
}

// Returns the sign of the exact edge function; if that is 0, the sign after moving the ray by (e, e^2) for a vanishing
// e > 0 (simulation of simplicity), so that exactly one of the triangles around an edge or a vertex is hit, for any
// winding. 0 only for a collapsed edge.
FUNC int exact_side(vec3 vertex_a, vec3 vertex_b) {
    float scale = room_above(vertex_a, vertex_b);
    vec3 a = scaled_across(vertex_a, scale);
    vec3 b = scaled_across(vertex_b, scale);
    PRECISE float p = a.x * b.y;
    PRECISE float q = a.y * b.x;
    if (p != q) return p > q ? 1 : -1;
    float area = accurate_edge_function(a, b);
    if (area != 0.0f) return area > 0.0f ? 1 : -1;
    if (a.y != b.y) return a.y > b.y ? 1 : -1;
    return b.x > a.x ? 1 : (b.x < a.x ? -1 : 0);
}

struct TriangleHit {
    float t;
    float t_low;  // the rounding of t, at LEVEL_CERTIFIED; else 0
    float u;
    float v;
    bool along;  // the normal (v1 - v0) x (v2 - v0) points along the ray, not against it
};

// Returns t, u, v where the ray crosses the plane of the sheared vertices.
FUNC TriangleHit crossing(vec3 a, vec3 b, vec3 c, float shear_z) {
    float area_a = accurate_edge_function(b, c);
    float area_b = accurate_edge_function(c, a);
    float area_c = accurate_edge_function(a, b);
    PRECISE float det = area_a + area_b;
    det = det + area_c;
    // It divides before it multiplies: a product of three lengths leaves the range of float32 at 1e13 and at 1e-13.
    PRECISE float weight_a = area_a / det;
    PRECISE float weight_b = area_b / det;
    PRECISE float weight_c = area_c / det;
    PRECISE float za = weight_a * a.z;
    PRECISE float zb = weight_b * b.z;
    PRECISE float zc = weight_c * c.z;
    PRECISE float z = za + zb;
    z = z + zc;
    PRECISE float t = z * shear_z;
    TriangleHit hit;
    hit.t = t;
    hit.t_low = 0.0f;
    hit.u = weight_b;
    hit.v = weight_c;
    hit.along = (det > 0.0f) == (shear_z > 0.0f);
    return hit;
}

// Returns whether one of them is 0 or denormal, which devices may take for 0. It uses the bits: compilers make the
// least of the magnitudes from three comparisons, for which drivers on CPUs take three times as long.
FUNC bool is_any_zero(float a, float b, float c) {
    return min(min(floatBitsToUint(a) << 1u, floatBitsToUint(b) << 1u), floatBitsToUint(c) << 1u) < 0x1000000u;
}

// A triangle as a ray sees it: its sheared vertices, and twice the signed areas between the ray and its edges.
struct SeenTriangle {
    vec3 a;
    vec3 b;
    vec3 c;
    float area_a;
    float area_b;
    float area_c;
};

FUNC SeenTriangle seen_triangle(vec3 v0, vec3 v1, vec3 v2, RaySpace space) {
    SeenTriangle seen;
    seen.a = sheared(v0, space);
    seen.b = sheared(v1, space);
    seen.c = sheared(v2, space);
    seen.area_a = edge_function(seen.b, seen.c);
    seen.area_b = edge_function(seen.c, seen.a);
    seen.area_c = edge_function(seen.a, seen.b);
    return seen;
}

// Returns whether the ray's line meets it, by exact_side. This is rarely called, so that a loop of little code is
// better than a fast one. Its vertices change places until each is where it was, because copies would take registers.
FUNC bool is_exactly_around(INOUT(SeenTriangle) seen) {
    int sides = 0;
    DONT_UNROLL for (uint edge = 0u; edge < 3u; edge = edge + 1u) {
        sides = sides + exact_side(seen.b, seen.c);
        vec3 first = seen.a;
        seen.a = seen.b;
        seen.b = seen.c;
        seen.c = first;
    }
    return sides == 3 || sides == -3;
}

// Returns whether the ray's line meets it.
FUNC bool is_around_ray(INOUT(SeenTriangle) seen) {
    bool is_met = (seen.area_a < 0.0f) == (seen.area_b < 0.0f) && (seen.area_b < 0.0f) == (seen.area_c < 0.0f);
    if (is_any_zero(seen.area_a, seen.area_b, seen.area_c)) {
        is_met = is_exactly_around(seen);
    }
    return is_met;
}

// ---- The side of a triangle's plane on which a point lies, exact for floats, however near to it

// Returns the exponent of the lowest bit that is set; NONE of 0 and of denormals, which count as 0.
FUNC int lowest_exponent(float x) {
    const int NONE = 1000;
    uint bits = floatBitsToUint(x);
    uint field = bits >> 23u & 0xffu;
    return field == 0u ? NONE : int(field) - 150 + int(findLSB((bits & 0x7fffffu) | 0x800000u));
}

// Returns (x - from) / unit for two whole multiples of it; some number below 2^31 if they are none.
FUNC int whole_difference(float x, float from, float inverse_unit) {
    PRECISE float difference = x - from;
    float missing = sum_error(x, -from, difference);
    return int(within(difference * inverse_unit, 1073741824.0f)) + int(within(missing * inverse_unit, 1048576.0f));
}

// Adds a b c, each of them below 2^30, to a number of 96 bits.
FUNC uvec3 plus_product(uvec3 sum, int a, int b, int c) {
    uvec2 of_two = multiply64(uint(abs(b)), uint(abs(c)));
    uvec2 low = multiply64(uint(abs(a)), of_two.x);
    uvec2 high = add64(multiply64(uint(abs(a)), of_two.y), uvec2(low.y, 0u));
    // Negates in two's complement: ~x + 1.
    uint flips = (a ^ b ^ c) < 0 ? 0xffffffffu : 0u;
    uvec2 first = add64(uvec2(low.x ^ flips, 0u), uvec2(flips & 1u, 0u));
    first = add64(first, uvec2(sum.x, 0u));
    uvec2 second = add64(uvec2(high.x ^ flips, 0u), uvec2(sum.y, 0u));
    second = add64(second, uvec2(first.y, 0u));
    return uvec3(first.x, second.x, sum.z + (high.y ^ flips) + second.y);
}

// Finds the sign of det(v0 - from, v1 - from, v2 - from), 0 in the plane, in whole numbers. Returns false if these have
// more than 30 bits: if coordinates of an axis differ by more than 2^30 of their lowest bit, or that is below 2^-126.
// It is rarely called: loops turn the axes, as is_exactly_around() turns vertices. The whole numbers take the places of
// the coordinates, and none a register of its own.
FUNC bool plane_side(vec3 v0, vec3 v1, vec3 v2, vec3 from, INOUT(int) side) {
    const float MOST = 1073741824.0f;  // 2^30
    uvec3 a = uvec3(floatBitsToUint(v0.x), floatBitsToUint(v0.y), floatBitsToUint(v0.z));
    uvec3 b = uvec3(floatBitsToUint(v1.x), floatBitsToUint(v1.y), floatBitsToUint(v1.z));
    uvec3 c = uvec3(floatBitsToUint(v2.x), floatBitsToUint(v2.y), floatBitsToUint(v2.z));
    bool is_whole = true;
    DONT_UNROLL for (uint axis = 0u; axis < 3u; axis = axis + 1u) {
        float x0 = uintBitsToFloat(a.x);
        float x1 = uintBitsToFloat(b.x);
        float x2 = uintBitsToFloat(c.x);
        float x = axis == 0u ? from.x : (axis == 1u ? from.y : from.z);
        int exponent = min(min(lowest_exponent(x0), lowest_exponent(x1)), min(lowest_exponent(x2), lowest_exponent(x)));
        float inverse_unit = uintBitsToFloat(uint(127 - min(max(exponent, -126), 126)) << 23u);
        float size = max(abs(x0 - x), max(abs(x1 - x), abs(x2 - x)));
        is_whole = is_whole && exponent >= -126 && size * inverse_unit < MOST;
        a = uvec3(a.y, a.z, uint(whole_difference(x0, x, inverse_unit)));
        b = uvec3(b.y, b.z, uint(whole_difference(x1, x, inverse_unit)));
        c = uvec3(c.y, c.z, uint(whole_difference(x2, x, inverse_unit)));
    }
    // The loop adds the three even products, exchanges b and c, and subtracts the three odd ones.
    uvec3 sum = uvec3(0u);
    DONT_UNROLL for (uint i = 0u; i < 6u; i = i + 1u) {
        sum = plus_product(sum, i < 3u ? int(a.x) : -int(a.x), int(b.y), int(c.z));
        a = uvec3(a.y, a.z, a.x);
        uvec3 next_b = uvec3(b.y, b.z, b.x);
        uvec3 next_c = uvec3(c.y, c.z, c.x);
        b = i == 2u ? next_c : next_b;
        c = i == 2u ? next_b : next_c;
    }
    side = (sum.x | sum.y | sum.z) == 0u ? 0 : (sum.z >> 31u != 0u ? -1 : 1);
    return is_whole;
}

// Returns whether rounding may hide on which side of the triangle's plane the ray begins: the triangle reaches behind
// the origin and ahead of it, and its areas' mean of z is 0 but for an error. Vertices are sheared to within 6 u of
// their distance from the origin, areas are off by that times the triangle's width and height (u = 2^-24).
FUNC bool may_begin_in_plane(SeenTriangle seen) {
    const float ROUNDINGS = 3.814697265625e-06f;  // 64 u
    float across = abs(seen.a.x) + abs(seen.b.x) + abs(seen.c.x) + abs(seen.a.y) + abs(seen.b.y) + abs(seen.c.y);
    float along = abs(seen.a.z) + abs(seen.b.z) + abs(seen.c.z);
    float mean = seen.area_a * seen.a.z + seen.area_b * seen.b.z + seen.area_c * seen.c.z;
    bool is_around = min(seen.a.z, min(seen.b.z, seen.c.z)) <= 0.0f && max(seen.a.z, max(seen.b.z, seen.c.z)) >= 0.0f;
    return is_around && abs(mean) <= ROUNDINGS * along * across * (across + along);
}

// The sign of t if rounding may hide it, at all levels but fast. It is asked for in one visit of the triangle, computed
// between two, and used in the next: computing it needs many registers, which a visit needs for itself.
const uint SIGN_UNASKED = 0u;        // nothing is asked; or answered: the triangle is not ahead of the ray's origin
const uint SIGN_ASKED_AGAINST = 1u;  // asked; TriangleHit::along is false
const uint SIGN_ASKED_ALONG = 2u;    // asked; it is true
const uint SIGN_POSITIVE = 3u;       // answered
const uint SIGN_AS_ROUNDED = 4u;     // answered: plane_side() cannot tell

FUNC uint asked_sign(bool along) { return along ? SIGN_ASKED_ALONG : SIGN_ASKED_AGAINST; }
FUNC bool is_sign_asked(uint sign_of_t) { return sign_of_t == SIGN_ASKED_ALONG || sign_of_t == SIGN_ASKED_AGAINST; }

// Computes the sign that was asked for.
FUNC uint told_sign(vec3 v0, vec3 v1, vec3 v2, vec3 origin, uint asked) {
    int side = 0;
    if (!plane_side(v0, v1, v2, origin, side)) return SIGN_AS_ROUNDED;
    return side == (asked == SIGN_ASKED_ALONG ? 1 : -1) ? SIGN_POSITIVE : SIGN_UNASKED;
}

// Gives t the computed sign.
FUNC float signed_t(float t, uint sign_of_t) {
    const float LEAST_NORMAL = uintBitsToFloat(0x00800000u);
    return sign_of_t == SIGN_POSITIVE ? max(t, LEAST_NORMAL) : t;
}

// Returns whether the ray's line meets the triangle, and where, without an interval test. Returns false with sign_of_t
// asked if it is not known yet: see told_sign().
FUNC bool intersect_seen(INOUT(SeenTriangle) seen, RaySpace space, INOUT(uint) sign_of_t, INOUT(TriangleHit) hit) {
    bool is_met = is_around_ray(seen);
    if (is_met) {
        bool asks = sign_of_t == SIGN_UNASKED && may_begin_in_plane(seen);
        hit = crossing(seen.a, seen.b, seen.c, space.shear_z);
        hit.t = signed_t(hit.t, sign_of_t);
        if (asks) sign_of_t = asked_sign(hit.along);
        is_met = !asks;
    }
    return is_met;
}
FUNC bool intersect_triangle(vec3 v0, vec3 v1, vec3 v2, RaySpace space, INOUT(uint) sign_of_t, INOUT(TriangleHit) hit) {
    SeenTriangle seen = seen_triangle(v0, v1, v2, space);
    return intersect_seen(seen, space, sign_of_t, hit);
}

// Does the same with the sign of t computed at once: for hosts, which have registers enough. Returns false if that sign
// is not positive.
FUNC bool intersect_triangle_signed(vec3 v0, vec3 v1, vec3 v2, RaySpace space, INOUT(TriangleHit) hit) {
    uint sign_of_t = SIGN_UNASKED;
    bool is_met = intersect_triangle(v0, v1, v2, space, sign_of_t, hit);
    if (!is_sign_asked(sign_of_t)) return is_met;
    sign_of_t = told_sign(v0, v1, v2, space.origin, sign_of_t);
    return sign_of_t != SIGN_UNASKED && intersect_triangle(v0, v1, v2, space, sign_of_t, hit);
}

// The same as intersect_triangle() by Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997:
// fewer operations, but each triangle decides for itself about a ray through an edge, so that it may be lost or found
// twice.
FUNC bool intersect_triangle_fast(vec3 v0, vec3 v1, vec3 v2, RaySpace space, INOUT(TriangleHit) hit) {
    vec3 e1 = v1 - v0;
    vec3 e2 = v2 - v0;
    vec3 p = cross(space.direction, e2);
    float det = dot(e1, p);
    if (det == 0.0f) return false;
    vec3 s = space.origin - v0;
    vec3 q = cross(s, e1);
    hit.u = dot(s, p) / det;
    hit.v = dot(space.direction, q) / det;
    hit.t = dot(e2, q) / det;
    hit.t_low = 0.0f;
    hit.along = det < 0.0f;
    return hit.u >= 0.0f && hit.v >= 0.0f && hit.u + hit.v <= 1.0f;
}
#endif
