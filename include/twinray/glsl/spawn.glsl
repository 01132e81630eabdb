// SPDX-License-Identifier: MIT
// Points of triangles that rays met, and safe ones for rays to start from, for kernels that trace by
// twinray/glsl/query.glsl or write rays for a batch:
//
//     Placement placement = placement_of(AT(push.instances, 0));   // AbstractAccel::instance_buffer().records
//     TriangleVertices vertices = vertices_of(push.positions, push.indices, hit.primitive_index);
//     SurfacePoint point = surface_point(placement, vertices, vec2(hit.u, hit.v));
//     Ray shadow = Ray(spawn_position(point, dot(to_light, point.normal) > 0.0), 0.0, to_light, 1.0);
//
// twinray/glsl/spawn.h says what is guaranteed.
#ifndef TWINRAY_SPAWN_GLSL
#define TWINRAY_SPAWN_GLSL
#include "twinray/glsl/common.glsl"
#include "shaders/shared/intersect.h"
#include "twinray/glsl/spawn.h"

// (u, v, t) of where the ray crosses the plane of the triangle, pulled into the triangle, without asking whether it meets
// that. Accelerators round t, u and v in their own ways; this depends on the ray and the triangle alone.
vec3 crossing_of(Ray ray, Placement placement, TriangleVertices vertices)
{
    RaySpace space = make_ray_space(transform_point(placement.to_object, ray.origin),
                                    transform_vector(placement.to_object, ray.direction), 0.0);
    vec3 a = sheared(vertices.a, space);
    vec3 b = sheared(vertices.b, space);
    vec3 c = sheared(vertices.c, space);
    TriangleHit hit = crossing(a, b, c, space.shear_z);
    // Compare and select: a NaN, where the triangle is seen edge on, becomes 0.
    float u = hit.u > 0.0 ? (hit.u < 1.0 ? hit.u : 1.0) : 0.0;
    float v = hit.v > 0.0 ? (hit.v < 1.0 - u ? hit.v : 1.0 - u) : 0.0;
    return vec3(u, v, hit.t);
}
#endif
