// SPDX-License-Identifier: MIT
// Level refined: float64, spent once per ray instead of once per triangle, restores the digits that float32 loses.
//  - A ray from far away is traced from near the scene: its origin moves along it, computed in float64. Rounding is
//    then relative to the scene's size, not to the distance.
//  - The hit that counts is computed again in float64 from what the user gave: the ray, the vertices, the transform.
#ifndef TWINRAY_SHARED_REFINE_H
#define TWINRAY_SHARED_REFINE_H
#include "shaders/shared/exact_double.h"
#include "shaders/shared/refine_scene.h"
#include "shaders/shared/trace.h"

// The t at which the line o + t d enters the slab between lo and hi; d is not 0.
FUNC double slab_entry(float o, float d, float lo, float hi)
{
    double near = d > 0.0f ? double(lo) : double(hi);
    PRECISE double way = near - double(o);
    PRECISE double t = way / double(d);
    return t;
}

// The same ray from nearer to the box, if it comes from more than five times as far as the box's largest coordinate: t
// of the result plus `advance` is t of `ray`. It stops about that coordinate short of the box, so nothing is jumped
// over. Nearer rays pay for one comparison.
FUNC Ray advanced(Ray ray, vec3 lo, vec3 hi, uint level, INOUT(double) advance)
{
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
    // Certified tests the given interval itself: the moved ray's rounding must not exclude hits.
    if (level == LEVEL_CERTIFIED && near.t_min > 0.0f) near.t_min = uintBitsToFloat(floatBitsToUint(near.t_min) - 1u);
    if (level == LEVEL_CERTIFIED && near.t_max > 0.0f) near.t_max = uintBitsToFloat(floatBitsToUint(near.t_max) + 1u);
    advance = way;
    return near;
}

// A vertex in world space, seen from the origin.
FUNC dvec3 vertex_from(dvec3 origin, GivenMesh mesh, uint vertex)
{
    uint at = 3u * AT(mesh.indices, vertex); // load_position costs AMD's compilers up to 40 registers here
    dvec3 v = dvec3(double(AT(mesh.positions, at)), double(AT(mesh.positions, at + 1u)),
                    double(AT(mesh.positions, at + 2u)));
    vec4 r0 = mesh.object_to_world.r0;
    vec4 r1 = mesh.object_to_world.r1;
    vec4 r2 = mesh.object_to_world.r2;
    PRECISE double x = product_sum(dvec3(double(r0.x), double(r0.y), double(r0.z)), v) + (double(r0.w) - origin.x);
    PRECISE double y = product_sum(dvec3(double(r1.x), double(r1.y), double(r1.z)), v) + (double(r1.w) - origin.y);
    PRECISE double z = product_sum(dvec3(double(r2.x), double(r2.y), double(r2.z)), v) + (double(r2.w) - origin.z);
    return dvec3(x, y, z);
}

// t in float32, within the interval that the hit was accepted in.
FUNC float rounded_within(double t, Ray ray)
{
    float rounded = float(t);
    float t_min = max(ray.t_min, 0.0f);
    if (!(rounded > t_min)) rounded = uintBitsToFloat(floatBitsToUint(t_min) + 1u);
    if (!(rounded < ray.t_max)) rounded = uintBitsToFloat(floatBitsToUint(ray.t_max) - 1u);
    return rounded;
}

// The point nearest to 0. Of a triangle's vertices, it is the one from which the distance of its plane cancels least:
// in a mesh with coordinates of 1e-6 and 1e6, another one cost 20 units in the last place of t.
FUNC dvec3 nearest_of(dvec3 a, dvec3 b, dvec3 c)
{
    dvec3 nearest = a;
    if (product_sum(b, b) < product_sum(nearest, nearest)) nearest = b;
    if (product_sum(c, c) < product_sum(nearest, nearest)) nearest = c;
    return nearest;
}

// The point at which a line meets the plane of a triangle.
struct PlaneHit
{
    double det; // 0: the plane contains the line, and the others are no numbers
    double t;
    double u;
    double v;
};

FUNC PlaneHit meet_plane(dvec3 origin, dvec3 direction, GivenMesh mesh, uint primitive)
{
    PlaneHit met;
    dvec3 a = vertex_from(origin, mesh, 3u * primitive);
    dvec3 b = vertex_from(origin, mesh, 3u * primitive + 1u);
    dvec3 c = vertex_from(origin, mesh, 3u * primitive + 2u);
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
    met.t = way;
    met.u = weight_u;
    met.v = weight_v;
    return met;
}

// A hit of advanced(ray) as one of `ray`: t, u and v are what float64 gives, rounded once.
FUNC Hit refined(Hit hit, Ray ray, double advance, GivenMesh mesh)
{
    PRECISE double moved = double(hit.t) + advance;
    hit.t = rounded_within(moved, ray);
    if (is_absent(mesh.indices)) return hit;
    dvec3 origin = dvec3(double(ray.origin.x), double(ray.origin.y), double(ray.origin.z));
    dvec3 direction = dvec3(double(ray.direction.x), double(ray.direction.y), double(ray.direction.z));
    PlaneHit met = meet_plane(origin, direction, mesh, hit.primitive_index);
    if (met.det == double(0.0f)) return hit; // float32 has the last word
    hit.t = rounded_within(met.t, ray);
    hit.u = float(met.u);
    hit.v = float(met.v);
    return hit;
}
#endif
