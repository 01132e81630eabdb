// SPDX-License-Identifier: MIT
// Level certified: float64 decides which triangle a ray meets, and in which order, from the ray, the vertices and the
// transform as they were given. float32 only leaves out triangles that provably are no hit, within the bounds of its
// errors:
//  - Boxes are padded by what transforming the ray may move it, so that no box of a hit is passed by.
//  - A triangle is refused where two edges see the ray on opposite sides by more than their error bounds (a
//    floating-point filter: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//    Predicates", 1997).
// All else is decided in float64: the watertight test of intersect.h, in world space, with the same rule for ties. Hits
// keep 48 bits of t, so their order is right where the exact t differ by more than about 2^-46 of what they are made
// of.
#ifndef TWINRAY_SHARED_CERTIFIED_H
#define TWINRAY_SHARED_CERTIFIED_H
#include "shaders/shared/bvh.h"
#include "shaders/shared/intersect.h"
#include "shaders/shared/refine.h"

// The traced ray in object space.
struct CertifiedRay {
    vec3 origin;
    vec3 direction;
    // How far it may run from the exact one, in any coordinate anywhere in the geometry, and a vertex of it be sheared
    // to the wrong place.
    float error;
};

// Float64 maps the ray, so that what is left is rounding: with T the instance's translation, W the inverse and r its
// residual, the exact origin o' = W (o - T) and direction d' differ by r o' and r d', by less than 2^-48 |W| (|o| +
// |T|) (W T has been rounded, and may have cancelled) and 2^-48 |W| |d|, and by a rounding to float32 (2^-24). A point
// of the geometry is at most (|o'| + extent) / |d'| away. The shear along the longest axis doubles what is off, and
// rounds at most 12 times; another factor of 2 is slack for the roundings in this bound. `is_moved`: the ray is one of
// advanced(), whose origin is off by a rounding itself.
FUNC CertifiedRay certified_ray(RefineInstance instance, Ray ray, bool is_moved) {
    const float UNKNOWN = 1e37f;                             // larger than any mesh in built units: nothing is refused
    const double MAPPING = double(3.5527136788005009e-15f);  // 2^-48
    const double MOVING = double(HALF_ULP);
    RowsDouble to_object = instance.world_to_object;
    RowsDouble magnitude = absolute(to_object);
    Rows to_world = instance.placed.object_to_world;
    dvec3 translation = abs(dvec3(double(to_world.r0.w), double(to_world.r1.w), double(to_world.r2.w)));
    dvec3 o = dvec3(double(ray.origin.x), double(ray.origin.y), double(ray.origin.z));
    dvec3 d = dvec3(double(ray.direction.x), double(ray.direction.y), double(ray.direction.z));
    dvec3 origin = transform_vector_double(to_object, o) + offset_double(to_object);
    dvec3 direction = transform_vector_double(to_object, d);
    dvec3 origin_error = MAPPING * (transform_vector_double(magnitude, abs(o) + translation));
    if (is_moved) origin_error = origin_error + MOVING * transform_vector_double(magnitude, abs(o));
    dvec3 direction_error = MAPPING * transform_vector_double(magnitude, abs(d));
    CertifiedRay mapped;
    mapped.origin = vec3(float(origin.x), float(origin.y), float(origin.z));
    mapped.direction = vec3(float(direction.x), float(direction.y), float(direction.z));
    float reach = largest_entry(mapped.origin) + instance.extent;
    float moved = (instance.residual + HALF_ULP) * largest_entry(mapped.origin) + largest_entry_double(origin_error);
    float rotated =
        instance.residual + HALF_ULP + largest_entry_double(direction_error) / largest_entry(mapped.direction);
    float error = 4.0f * (moved + reach * rotated + reach * (6.0f * HALF_ULP));
    mapped.error = error < UNKNOWN ? error : UNKNOWN;
    return mapped;
}

// Returns 1 or -1 if the edge function of two sheared vertices, each off by at most `error` in x and y, has that sign
// for certain, else 0.
FUNC int certain_side(vec3 a, vec3 b, float error) {
    const float ROUNDINGS = 2.384185791015625e-07f;      // 4 of 2^-24
    const float LEAST_PRODUCT = 7.888609052210118e-31f;  // 2^-100: below, products may have been flushed
    PRECISE float p = a.x * b.y;
    PRECISE float q = a.y * b.x;
    PRECISE float area = p - q;
    float size = abs(a.x) + abs(a.y) + abs(b.x) + abs(b.y);
    float bound = error * (size + 2.0f * error) + ROUNDINGS * (abs(p) + abs(q)) + LEAST_PRODUCT;
    return area > bound ? 1 : (area < -bound ? -1 : 0);
}

// Does the work of exact_side and accurate_edge_function of intersect.h in float64.
FUNC double exact_edge_function_double(dvec3 a, dvec3 b, INOUT(int) side) {
    PRECISE double p = a.x * b.y;
    PRECISE double q = a.y * b.x;
    PRECISE double area = p - q;
    if (p == q) area = product_error_double(a.x, b.y, p) - product_error_double(a.y, b.x, q);
    if (p != q)
        side = p > q ? 1 : -1;
    else if (area != double(0.0f))
        side = area > double(0.0f) ? 1 : -1;
    else if (a.y != b.y)
        side = a.y > b.y ? 1 : -1;
    else
        side = b.x > a.x ? 1 : (b.x < a.x ? -1 : 0);
    return area;
}

FUNC dvec3 dominant_last_double(dvec3 v, uint axis) {
    return axis == 0u ? dvec3(v.y, v.z, v.x) : (axis == 1u ? dvec3(v.z, v.x, v.y) : v);
}

// Returns a vertex, relative to the ray's origin, seen along the direction d, whose dominant axis is the last.
FUNC dvec3 sheared_double(dvec3 vertex, dvec3 d, uint axis) {
    dvec3 p = dominant_last_double(vertex, axis);
    PRECISE double x = p.x - d.x / d.z * p.z;
    PRECISE double y = p.y - d.y / d.z * p.z;
    return dvec3(x, y, p.z);
}

// Does the work of may_begin_in_plane() of intersect.h in float64.
FUNC bool may_begin_in_plane_double(dvec3 a, dvec3 b, dvec3 c, double mean) {
    const double ROUNDINGS = double(7.1054273576010019e-15f);  // 64 u = 2^-47
    dvec3 size = abs(a) + abs(b) + abs(c);
    double across = size.x + size.y;
    bool is_around = min(a.z, min(b.z, c.z)) <= double(0.0f) && max(a.z, max(b.z, c.z)) >= double(0.0f);
    return is_around && abs(mean) <= ROUNDINGS * size.z * across * (across + size.z);
}

// Returns whether the given ray meets the triangle in world space within its interval, and where: t of the traced ray,
// which begins `advance` behind the given one, as t + t_low. Returns false with sign_of_t asked if float64 is not
// certain of it: told_sign() then tells it in object space.
FUNC bool intersect_in_world(uint primitive_index, uint instance_index, TraceOptions options, INOUT(uint) sign_of_t,
                             INOUT(TriangleHit) hit) {
    const double LEAST_NORMAL = double(uintBitsToFloat(0x00800000u));
    const double ROUNDINGS = double(1.4210854715202004e-14f);  // 2^-46
    InstancedMesh placed = AT(options.instances, instance_index).placed;
    vec3 o = options.given.origin;
    vec3 w = options.given.direction;
    dvec3 origin = dvec3(double(o.x), double(o.y), double(o.z));
    uint axis = dominant_axis(w);
    dvec3 d = dominant_last_double(dvec3(double(w.x), double(w.y), double(w.z)), axis);
    dvec3 a = sheared_double(vertex_from(origin, placed, 3u * primitive_index), d, axis);
    dvec3 b = sheared_double(vertex_from(origin, placed, 3u * primitive_index + 1u), d, axis);
    dvec3 c = sheared_double(vertex_from(origin, placed, 3u * primitive_index + 2u), d, axis);
    int side_a = 0;
    int side_b = 0;
    int side_c = 0;
    double area_a = exact_edge_function_double(b, c, side_a);
    double area_b = exact_edge_function_double(c, a, side_b);
    double area_c = exact_edge_function_double(a, b, side_c);
    if (side_a == 0 || side_a != side_b || side_b != side_c) return false;
    PRECISE double det = area_a + area_b + area_c;
    PRECISE double z = area_a / det * a.z + area_b / det * b.z + area_c / det * c.z;
    PRECISE double given_t = z / d.z;
    bool along_in_world = (det > double(0.0f)) == (d.z > double(0.0f));
    bool along_in_object = along_in_world != (AT(options.instances, instance_index).is_mirrored != 0u);
    if (sign_of_t == SIGN_UNASKED && may_begin_in_plane_double(a, b, c, z * det)) {
        sign_of_t = asked_sign(along_in_object);
        return false;
    }
    if (sign_of_t == SIGN_POSITIVE) given_t = max(given_t, LEAST_NORMAL);
    // t is rounded by less than 2^-46 of the depths that it is a mean of.
    PRECISE double rounding = ROUNDINGS * ((abs(a.z) + abs(b.z) + abs(c.z)) / abs(d.z));
    if (!(given_t > double(0.0f)) || !is_between_ends(given_t, rounding, options.given)) return false;
    PRECISE double t = given_t - options.advance;
    double high = rounded_to_24_bits(t);
    PRECISE double low = t - high;
    hit.t = float(high);
    hit.t_low = float(low);
    hit.u = float(area_b / det);
    hit.v = float(area_c / det);
    hit.along = along_in_object;
    return abs(hit.t) <= 3.402823466e+38f;  // no t beyond the largest float can be reported
}

#endif
