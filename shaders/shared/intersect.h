// SPDX-License-Identifier: MIT
// Watertight ray-box and ray-triangle tests.
#ifndef TWINRAY_SHARED_INTERSECT_H
#define TWINRAY_SHARED_INTERSECT_H
#include "shaders/shared/exact.h"
#include "shaders/shared/ray.h"
#include "shaders/shared/transform.h"

// A ray prepared for one coordinate space.
//  - Boxes: near and far planes use reciprocals padded by a factor 1 -+ 2^-20, which covers the 2.5 ulp that Vulkan
//    allows a division and the roundings of (plane - origin) * reciprocal (Ize, "Robust BVH Ray Traversal", 2013,
//    with the constant for Vulkan), and origins shifted by an absolute pad for what an instance transform adds.
//    Reciprocals have a limit: across the dominant axis a ray counts as moving by 2^-40 of what it moves along it at least,
//    far less than the pad. So they are finite for directions of any use. Where the distance to what lies in the space is
//    beyond 2^80 in t, t of boxes is taken times a power of two, so that no product of a box with them overflows.
//  - Triangles: shear constants of Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", 2013.
struct RaySpace
{
    vec3 origin;
    vec3 direction;
    vec3 inverse; // of the direction, within the limit, times t_scale
    float pad;
    float t_scale; // of t of boxes
    uint axis; // the dominant axis of the direction
    float shear_x;
    float shear_y;
    float shear_z;
};

// What tests of boxes take from it. Made from it at each node where the space changes in the loop, as among instances: that is
// less than a loop on a CPU pays for what it carries.
struct BoxRay
{
    vec3 near_origin;
    vec3 far_origin;
    vec3 near_inverse; // times t_scale
    vec3 far_inverse;
    float t_scale;
};

FUNC float reciprocal(float d)
{
    // 1/0 is written out: Vulkan leaves the division undefined. Its sign is that of the zero.
    return d == 0.0f ? uintBitsToFloat(0x7f800000u | (floatBitsToUint(d) & 0x80000000u)) : 1.0f / d;
}

FUNC uint dominant_axis(vec3 direction)
{
    vec3 size = abs(direction);
    return size.x >= size.y ? (size.x >= size.z ? 0u : 2u) : (size.y >= size.z ? 1u : 2u);
}

FUNC vec3 dominant_last(vec3 v, uint axis)
{
    return axis == 0u ? vec3(v.y, v.z, v.x) : (axis == 1u ? vec3(v.z, v.x, v.y) : v);
}

FUNC BoxRay box_ray(RaySpace space)
{
#ifdef TWINRAY_NO_PADDING // a negative control: shows what the padding is for
    const float NEAR_FACTOR = 1.0f;
    const float FAR_FACTOR = 1.0f;
#else
    const float NEAR_FACTOR = 0.99999904632568359375f; // 1 - 2^-20
    const float FAR_FACTOR = 1.00000095367431640625f;  // 1 + 2^-20
#endif
    vec3 inverse = space.inverse;
    float pad = space.pad;
    vec3 shift = vec3(inverse.x < 0.0f ? -pad : pad, inverse.y < 0.0f ? -pad : pad, inverse.z < 0.0f ? -pad : pad);
    PRECISE vec3 near_origin = space.origin + shift;
    PRECISE vec3 far_origin = space.origin - shift;
    PRECISE vec3 near_inverse = inverse * NEAR_FACTOR;
    PRECISE vec3 far_inverse = inverse * FAR_FACTOR;
    BoxRay ray;
    ray.near_origin = near_origin;
    ray.far_origin = far_origin;
    ray.near_inverse = near_inverse;
    ray.far_inverse = far_inverse;
    ray.t_scale = space.t_scale;
    return ray;
}

// 1, or the power of two that brings the largest t at which a ray may meet something below 2^80. That is 2^38 pads at most times
// the reciprocal of the direction's dominant entry.
FUNC float scale_of_reach(float pad, float along)
{
    uint exponent = (floatBitsToUint(pad) >> 23u) + (floatBitsToUint(along) >> 23u);
    const uint HIGHEST = 80u - 38u + 254u;
    return uintBitsToFloat((127u - min(max(exponent, HIGHEST) - HIGHEST, 126u)) << 23u);
}

// pad: see above; 2^-38 of the coordinates of the origin and of all boxes at least.
FUNC RaySpace make_ray_space(vec3 origin, vec3 direction, float pad)
{
#ifdef TWINRAY_NO_PADDING
    pad = 0.0f;
#endif
    const float LARGEST_FLOAT = uintBitsToFloat(0x7f7fffffu);
    const float STEEPEST = 1099511627776.0f; // 2^40
    RaySpace space;
    space.origin = origin;
    space.direction = direction;
    space.axis = dominant_axis(direction);
    vec3 d = dominant_last(direction, space.axis);
    vec3 inverse = vec3(reciprocal(direction.x), reciprocal(direction.y), reciprocal(direction.z));
    float along = abs(reciprocal(d.z));
    vec3 limit = vec3(min(STEEPEST * along, LARGEST_FLOAT));
    space.t_scale = scale_of_reach(pad, along);
    inverse = clamp(inverse, -limit, limit) * space.t_scale;
    space.inverse = inverse;
    space.pad = pad;
    space.shear_x = d.x / d.z;
    space.shear_y = d.y / d.z;
    space.shear_z = 1.0f / d.z;
    return space;
}

// How far aside of a ray a corner may be sheared, rounded: 8 of 2^-24 of its distance along an axis. A triangle is hit where its
// sheared corners say so, and its box must be, too, however near to the ray's origin that is.
FUNC float corner_pad(vec3 origin, float extent) { return (largest_entry(origin) + extent) * 9.5367431640625e-07f; } // 2^-20

// The interval in which a ray is inside of all three slabs, begun with its own. Compare-and-select instead of min/max: a NaN
// (products out of range) must leave the interval as it was, which GLSL does not promise of min/max.
FUNC float latest_of(float enter, float near_x, float near_y, float near_z)
{
    enter = near_x > enter ? near_x : enter;
    enter = near_y > enter ? near_y : enter;
    return near_z > enter ? near_z : enter;
}
FUNC float earliest_of(float leave, float far_x, float far_y, float far_z)
{
    leave = far_x < leave ? far_x : leave;
    leave = far_y < leave ? far_y : leave;
    return far_z < leave ? far_z : leave;
}

// Where the ray enters the box and where it leaves it within [t_min, t_max], in t * ray.t_scale: enter > leave where it does
// not meet it.
FUNC void cross_box(vec3 lo, vec3 hi, BoxRay ray, float t_min, float t_max, INOUT(float) enter, INOUT(float) leave)
{
    bool flip_x = ray.near_inverse.x < 0.0f;
    bool flip_y = ray.near_inverse.y < 0.0f;
    bool flip_z = ray.near_inverse.z < 0.0f;
    PRECISE float near_x = ((flip_x ? hi.x : lo.x) - ray.near_origin.x) * ray.near_inverse.x;
    PRECISE float near_y = ((flip_y ? hi.y : lo.y) - ray.near_origin.y) * ray.near_inverse.y;
    PRECISE float near_z = ((flip_z ? hi.z : lo.z) - ray.near_origin.z) * ray.near_inverse.z;
    PRECISE float far_x = ((flip_x ? lo.x : hi.x) - ray.far_origin.x) * ray.far_inverse.x;
    PRECISE float far_y = ((flip_y ? lo.y : hi.y) - ray.far_origin.y) * ray.far_inverse.y;
    PRECISE float far_z = ((flip_z ? lo.z : hi.z) - ray.far_origin.z) * ray.far_inverse.z;
    PRECISE float first = t_min * ray.t_scale;
    PRECISE float last = t_max * ray.t_scale;
    enter = latest_of(first, near_x, near_y, near_z);
    leave = earliest_of(last, far_x, far_y, far_z);
}

FUNC bool enter_box(vec3 lo, vec3 hi, RaySpace space, float t_min, float t_max, INOUT(float) enter)
{
    float leave = 0.0f;
    cross_box(lo, hi, box_ray(space), t_min, t_max, enter, leave);
    return enter <= leave;
}

// A corner seen along the ray: x, y sheared so that the ray is the point (0, 0), z along the dominant axis. It depends
// on the corner and the ray alone, so all triangles that share the corner see the same point.
FUNC vec3 sheared(vec3 corner, RaySpace space)
{
    PRECISE vec3 relative = corner - space.origin;
    vec3 p = dominant_last(relative, space.axis);
    PRECISE float move_x = space.shear_x * p.z;
    PRECISE float move_y = space.shear_y * p.z;
    PRECISE float x = p.x - move_x;
    PRECISE float y = p.y - move_y;
    return vec3(x, y, p.z);
}

// Twice the signed area of (0, a, b). Rounding is monotone: a nonzero result has the right sign.
FUNC float edge_function(vec3 a, vec3 b)
{
    PRECISE float p = a.x * b.y;
    PRECISE float q = a.y * b.x;
    PRECISE float area = p - q;
#ifdef TWINRAY_CONTRACTED // a negative control: what fma(a.x, b.y, -q) gives, for drivers that do not contract
    PRECISE double fused = double(a.x) * double(b.y) - double(q);
    area = float(fused);
#endif
    return area;
}

// The same to a rounding or two of itself, where edge_function is right to roundings of its products alone: in slivers
// they cancel, and the weights of the corners with them.
FUNC float accurate_edge_function(vec3 a, vec3 b)
{
    float missing = 0.0f;
    PRECISE float area = doubled_difference(a.x, b.y, a.y, b.x, missing);
    // Never to the other sign; and above 2^115 products cannot be split.
    if (abs(missing) <= abs(area) || area == 0.0f) area = area + missing;
    return area;
}

// By which power of two x and y of two sheared corners may be multiplied, exactly and without overflow of a product: where a
// ray passes a vertex by a denormal distance, the products that decide would underflow, some to 0, and triangles around the
// vertex would disagree. It depends on the edge alone, so that both of its triangles see the same.
FUNC float room_above(vec3 a, vec3 b)
{
    const float TARGET = 1.152921504606846976e+18f;    // 2^60
    const float MOST = 1.329227995784915872903807e36f; // 2^120
    float largest = max(max(abs(a.x), abs(a.y)), max(abs(b.x), abs(b.y)));
    PRECISE float to_target = TARGET / power_of_two_below(largest);
    return largest < TARGET / MOST ? MOST : max(to_target, 1.0f);
}

FUNC vec3 scaled_across(vec3 v, float scale)
{
    PRECISE float x = v.x * scale;
    PRECISE float y = v.y * scale;
    return vec3(x, y, v.z);
}

// The sign of the exact edge function, and where that is 0, the sign after moving the ray by (e, e^2) for a vanishing
// e > 0 (simulation of simplicity), so that exactly one of the triangles around an edge or a corner is hit, for any
// winding. 0 only for a collapsed edge.
FUNC int exact_side(vec3 corner_a, vec3 corner_b)
{
    float scale = room_above(corner_a, corner_b);
    vec3 a = scaled_across(corner_a, scale);
    vec3 b = scaled_across(corner_b, scale);
    PRECISE float p = a.x * b.y;
    PRECISE float q = a.y * b.x;
    if (p != q) return p > q ? 1 : -1;
    float area = accurate_edge_function(a, b);
    if (area != 0.0f) return area > 0.0f ? 1 : -1;
    if (a.y != b.y) return a.y > b.y ? 1 : -1;
    return b.x > a.x ? 1 : (b.x < a.x ? -1 : 0);
}

struct TriangleHit
{
    float t;
    float t_low; // what t was rounded by, at LEVEL_CERTIFIED; else 0
    float u;
    float v;
    bool along; // the normal (v1 - v0) x (v2 - v0) points along the ray, not against it
};

// t, u, v where the ray crosses the plane of the sheared corners.
FUNC TriangleHit crossing(vec3 a, vec3 b, vec3 c, float shear_z)
{
    float area_a = accurate_edge_function(b, c);
    float area_b = accurate_edge_function(c, a);
    float area_c = accurate_edge_function(a, b);
    PRECISE float det = area_a + area_b;
    det = det + area_c;
    // Divided before it is multiplied: a product of three lengths leaves the range of float32 at 1e13 and at 1e-13.
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

// Whether the ray's line meets the triangle (a, b, c), and where. No interval test.
FUNC bool intersect_triangle(vec3 v0, vec3 v1, vec3 v2, RaySpace space, INOUT(TriangleHit) hit)
{
    vec3 a = sheared(v0, space);
    vec3 b = sheared(v1, space);
    vec3 c = sheared(v2, space);
    float area_a = edge_function(b, c);
    float area_b = edge_function(c, a);
    float area_c = edge_function(a, b);
    bool is_met = (area_a < 0.0f) == (area_b < 0.0f) && (area_b < 0.0f) == (area_c < 0.0f);
    if (area_a == 0.0f || area_b == 0.0f || area_c == 0.0f)
    {
        int side_a = exact_side(b, c);
        is_met = side_a != 0 && side_a == exact_side(c, a) && side_a == exact_side(a, b);
    }
    if (is_met) hit = crossing(a, b, c, space.shear_z);
    return is_met;
}

// The same by Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997: fewer operations, but each
// triangle decides for itself about a ray through an edge, so that it may be lost or found twice.
FUNC bool intersect_triangle_fast(vec3 v0, vec3 v1, vec3 v2, RaySpace space, INOUT(TriangleHit) hit)
{
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
