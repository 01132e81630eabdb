// SPDX-License-Identifier: MIT
// Level refined: float64, spent once per ray instead of once per triangle, restores the digits that float32 loses.
//  - A ray from far away is traced from near the scene: its origin moves along it, computed in float64. Rounding is
//    then relative to the scene's size, not to the distance.
//  - The hit that counts is computed again in float64 from what the user gave: the ray, the vertices, the transform.
//    One at an end of the ray does not count, and the ray is traced again without it.
#ifndef TWINRAY_SHARED_REFINE_H
#define TWINRAY_SHARED_REFINE_H
#include "shaders/shared/refine_scene.h"
#include "shaders/shared/trace.h"

// Returns the t at which the line o + t d enters the slab between lo and hi; d is not 0.
FUNC double slab_entry(float o, float d, float lo, float hi) {
    double near = d > 0.0f ? double(lo) : double(hi);
    PRECISE double way = near - double(o);
    PRECISE double t = way / double(d);
    return t;
}

// The same ray from nearer to the box, if it comes from more than five times as far as the box's largest coordinate: t
// of the result plus `advance` is t of `ray`. It stops about that coordinate short of the box, so nothing is jumped
// over. Nearer rays pay for one comparison.
FUNC Ray advanced(Ray ray, vec3 lo, vec3 hi, INOUT(double) advance) {
    const float FAR_IN_SIZES = 4.0f;
    advance = double(0.0f);
    float size = max(largest_entry(lo), largest_entry(hi));
    PRECISE float far = FAR_IN_SIZES * size;
    // A ray that hits the box after FAR_IN_SIZES + 1 sizes began at least FAR_IN_SIZES sizes from 0.
    if (!(lo.x <= hi.x) || !(largest_entry(ray.origin) > far) || !is_traceable(ray)) return ray;
    double entry = double(0.0f);
    if (ray.direction.x != 0.0f) entry = max(entry, slab_entry(ray.origin.x, ray.direction.x, lo.x, hi.x));
    if (ray.direction.y != 0.0f) entry = max(entry, slab_entry(ray.origin.y, ray.direction.y, lo.y, hi.y));
    if (ray.direction.z != 0.0f) entry = max(entry, slab_entry(ray.origin.z, ray.direction.z, lo.z, hi.z));
    PRECISE double box_way = double(size) / double(largest_entry(ray.direction));
    PRECISE double way = entry - box_way;
    PRECISE double far_way = double(FAR_IN_SIZES) * box_way;
    if (!(way > far_way)) return ray;
    Ray near = ray;
    PRECISE double x = double(ray.origin.x) + way * double(ray.direction.x);
    PRECISE double y = double(ray.origin.y) + way * double(ray.direction.y);
    PRECISE double z = double(ray.origin.z) + way * double(ray.direction.z);
    near.origin = vec3(float(x), float(y), float(z));
    PRECISE double t_min = double(ray.t_min) - way;
    // No t beyond the largest float can be reported.
    PRECISE double t_max = double(min(ray.t_max, 3.402823466e+38f)) - way;
    near.t_min = max(float(t_min), 0.0f);
    near.t_max = float(t_max);
    advance = way;
    return near;
}

// Returns the ray to trace for options.given: advanced(), with a margin at both ends, since float64 tells what lies
// between them. Filters see hits before float64 does, so that their rays have none below certified.
FUNC Ray searched_ray(vec3 lo, vec3 hi, INOUT(TraceOptions) options) {
    const float MARGIN = 3.814697265625e-06f;  // 2^-18
    Ray ray = advanced(options.given, lo, hi, options.advance);
    if (options.level != LEVEL_CERTIFIED && (options.features & FEATURE_FILTERS) != 0u) return ray;
    PRECISE float t_min = ray.t_min - MARGIN * ray.t_min;
    PRECISE float t_max = ray.t_max + MARGIN * ray.t_max;
    if (ray.t_min > 0.0f) ray.t_min = t_min;
    if (ray.t_max > 0.0f) ray.t_max = max(ray.t_max, min(t_max, 3.402823466e+38f));
    return ray;
}

// Returns a vertex in world space, seen from the origin.
FUNC dvec3 vertex_from(dvec3 origin, InstancedMesh placed, uint vertex) {
    Floats positions = placed.mesh.positions;
    uint at = 3u * AT(placed.mesh.indices, vertex);  // load_position costs AMD's compilers up to 40 registers here
    dvec3 v = dvec3(double(AT(positions, at)), double(AT(positions, at + 1u)), double(AT(positions, at + 2u)));
    vec4 r0 = placed.object_to_world.r0;
    vec4 r1 = placed.object_to_world.r1;
    vec4 r2 = placed.object_to_world.r2;
    PRECISE double x = product_sum(dvec3(double(r0.x), double(r0.y), double(r0.z)), v) + (double(r0.w) - origin.x);
    PRECISE double y = product_sum(dvec3(double(r1.x), double(r1.y), double(r1.z)), v) + (double(r1.w) - origin.y);
    PRECISE double z = product_sum(dvec3(double(r2.x), double(r2.y), double(r2.z)), v) + (double(r2.w) - origin.z);
    return dvec3(x, y, z);
}

// Returns t in float32, within the interval that the hit was accepted in.
FUNC float rounded_within(double t, Ray ray) {
    float rounded = float(t);
    float t_min = max(ray.t_min, 0.0f);
    if (!(rounded > t_min)) rounded = uintBitsToFloat(floatBitsToUint(t_min) + 1u);
    if (!(rounded < ray.t_max)) rounded = uintBitsToFloat(floatBitsToUint(ray.t_max) - 1u);
    return rounded;
}

// Returns whether a hit at t, which is off by up to `rounding`, lies between the ends of a ray. A surface so near to an
// end is at the end, which does not count. Signs of t have been decided, so the origin is no end.
FUNC bool is_between_ends(double t, double rounding, Ray ray) {
    PRECISE double after_begin = double(ray.t_min) + rounding;
    PRECISE double before_end = double(ray.t_max) - rounding;
    bool is_behind = ray.t_min > 0.0f && t <= after_begin;
    return !is_behind && !(t >= before_end);
}

// Returns the point nearest to 0. Of a triangle's vertices, it is the one from which the distance of its plane cancels
// least: in a mesh with coordinates of 1e-6 and 1e6, another one cost 20 units in the last place of t.
FUNC dvec3 nearest_of(dvec3 a, dvec3 b, dvec3 c) {
    dvec3 nearest = a;
    if (product_sum(b, b) < product_sum(nearest, nearest)) nearest = b;
    if (product_sum(c, c) < product_sum(nearest, nearest)) nearest = c;
    return nearest;
}

// The point at which a line meets the plane of a triangle.
struct PlaneHit {
    double det;  // 0: the plane contains the line, and the others are no numbers
    double t;
    double rounding;  // of t
    double u;
    double v;
};

FUNC double sum_of_sizes(dvec3 v) {
    PRECISE double sum = abs(v.x) + abs(v.y) + abs(v.z);
    return sum;
}

FUNC PlaneHit meet_plane(dvec3 origin, dvec3 direction, InstancedMesh placed, uint primitive) {
    const double ROUNDINGS = double(1.4210854715202004e-14f);  // 2^-46
    PlaneHit met;
    dvec3 a = vertex_from(origin, placed, 3u * primitive);
    dvec3 b = vertex_from(origin, placed, 3u * primitive + 1u);
    dvec3 c = vertex_from(origin, placed, 3u * primitive + 2u);
    dvec3 e1 = b - a;
    dvec3 e2 = c - a;
    dvec3 normal = cross_product(e1, e2);
    met.det = product_sum(normal, direction);
    PRECISE double way = product_sum(normal, nearest_of(a, b, c)) / met.det;
    // The point from a, and its weights in the plane: w = u e1 + v e2, so (w x e2) = u n and (e1 x w) = v n.
    PRECISE double wx = direction.x * way - a.x;
    PRECISE double wy = direction.y * way - a.y;
    PRECISE double wz = direction.z * way - a.z;
    dvec3 w = dvec3(wx, wy, wz);
    double square = product_sum(normal, normal);
    PRECISE double weight_u = product_sum(cross_product(w, e2), normal) / square;
    PRECISE double weight_v = product_sum(cross_product(e1, w), normal) / square;
    PRECISE double depth = sum_of_sizes(a) + abs(way) * sum_of_sizes(direction);
    PRECISE double rounding = ROUNDINGS * sum_of_sizes(e1) * sum_of_sizes(e2) * depth / abs(met.det);
    met.t = way;
    met.rounding = rounding;
    met.u = weight_u;
    met.v = weight_v;
    return met;
}

const float REFINING_STEP = 2.384185791015625e-07f;  // 2^-22

// Shortens the ray, so that a triangle at one of its ends is not found again: by a share of t, at first
// REFINING_STEP.
FUNC void leave_out(float t, INOUT(Ray) ray, INOUT(float) step) {
    PRECISE float gap = step * abs(t);
    PRECISE float from_begin = abs(t - ray.t_min);
    PRECISE float to_end = abs(ray.t_max - t);
    PRECISE float before = min(ray.t_max, t) - gap;
    PRECISE float after = max(ray.t_min, t) + gap;
    if (to_end <= from_begin)
        ray.t_max = before;
    else
        ray.t_min = after;
    PRECISE float next = 4.0f * step;
    step = next;
}

// Makes a hit of the traced ray, `near`, one of the given ray: t, u and v are those of float64, rounded once. Returns
// false if it is at an end of that; `near` is then shorter, and to be traced again.
FUNC bool refine(INOUT(Hit) hit, INOUT(Ray) near, INOUT(float) step, TraceOptions options) {
    Ray ray = options.given;
    PRECISE double moved = double(hit.t) + options.advance;
    // Float32 has the last word in boxes, and if the plane contains the ray.
    PlaneHit traced;
    traced.det = double(0.0f);
    traced.t = moved;
    traced.rounding = double(0.0f);
    traced.u = double(hit.u);
    traced.v = double(hit.v);
    PlaneHit met = traced;
    InstancedMesh placed = AT(options.instances, hit.instance_index).placed;
    dvec3 origin = dvec3(double(ray.origin.x), double(ray.origin.y), double(ray.origin.z));
    dvec3 direction = dvec3(double(ray.direction.x), double(ray.direction.y), double(ray.direction.z));
    if (!is_absent(placed.mesh.indices)) met = meet_plane(origin, direction, placed, hit.primitive_index);
    if (met.det == double(0.0f)) met = traced;
    if (options.level != LEVEL_CERTIFIED && !is_between_ends(met.t, met.rounding, ray)) {
        PRECISE double t = met.t - options.advance;
        leave_out(float(t), near, step);
        return false;
    }
    hit.t = rounded_within(met.t, ray);
    hit.u = float(met.u);
    hit.v = float(met.v);
    return true;
}
#endif
