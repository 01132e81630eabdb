// SPDX-License-Identifier: MIT
// The crossing of a ray with a triangle that it is known to hit.
#ifndef TWINRAY_CROSSING_H
#define TWINRAY_CROSSING_H
#include "shaders/shared/intersect.h"
#include "twinray/glsl/spawn.h"

// The position on a triangle and along the ray.
struct Crossing {
    vec2 uv;  // within the triangle
    float t;
    bool is_front;  // the vertices are counter-clockwise, in object space, as seen from the ray
};

// Returns the crossing with the plane of the triangle, clamped to the triangle, without testing whether the ray hits
// it. Accelerators round t, u and v in their own ways; this depends only on the ray and the triangle.
FUNC Crossing crossing_of(Ray ray, Placement placement, TriangleVertices vertices) {
    RaySpace space = make_ray_space(transform_point(placement.to_object, ray.origin),
                                    transform_vector(placement.to_object, ray.direction), 0.0f);
    vec3 a = sheared(vertices.a, space);
    vec3 b = sheared(vertices.b, space);
    vec3 c = sheared(vertices.c, space);
    TriangleHit hit = crossing(a, b, c, space.shear_z);
    // Compare and select: a NaN, from a triangle seen edge on, becomes 0.
    float u = hit.u > 0.0f ? (hit.u < 1.0f ? hit.u : 1.0f) : 0.0f;
    float v = hit.v > 0.0f ? (hit.v < 1.0f - u ? hit.v : 1.0f - u) : 0.0f;
    Crossing result;
    result.uv = vec2(u, v);
    result.t = hit.t;
    result.is_front = !hit.along;
    return result;
}
#endif
