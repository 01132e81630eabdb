// SPDX-License-Identifier: MIT
// Points on triangles with bounds of their rounding errors, so that rays can start there without meeting their own
// triangle and without an absolute epsilon. After Bitterli et al., "Self-Intersection Avoidance", NVIDIA 2023.
#ifndef TWINRAY_PATH_TRACER_SPAWN_H
#define TWINRAY_PATH_TRACER_SPAWN_H

struct Placement
{
    Rows to_world;
    Rows to_object;
};

struct Corners
{
    vec3 a;
    vec3 b;
    vec3 c;
};

struct SurfacePoint
{
    vec3 position;      // world
    vec3 normal;        // geometric, unit, world; of the side on which the corners turn counter-clockwise
    vec3 normal_object; // unit
    float offset;       // world: how far along the normal a ray must start to be clear of the triangle
    vec3 error_object;  // bound of how far the point is from the triangle
};

FUNC vec3 xyz(vec4 v) { return vec3(v.x, v.y, v.z); }

// |m| applied to |v|: the scale of the rounding errors of the product.
FUNC vec3 magnitude_vector(Rows m, vec3 v)
{
    return vec3(dot(abs(xyz(m.r0)), abs(v)), dot(abs(xyz(m.r1)), abs(v)), dot(abs(xyz(m.r2)), abs(v)));
}
FUNC vec3 magnitude_offset(Rows m) { return vec3(abs(m.r0.w), abs(m.r1.w), abs(m.r2.w)); }

FUNC vec3 transposed_times(Rows m, vec3 v) { return xyz(m.r0) * v.x + xyz(m.r1) * v.y + xyz(m.r2) * v.z; }

const float HALF_ULP = 5.9604644775390625e-08f; // 2^-24
// The accelerators may round the inverse of the transform unlike us.
const float SPAWN_MARGIN = 2.0f;

// The point (1-u-v) a + u b + v c, as a + (u (b - a) + v (c - a)): the corner is added last, so that only one rounding
// is of the size of the coordinates.
FUNC SurfacePoint surface_point(Placement placement, Corners corners, vec2 uv)
{
    PRECISE vec3 edge1 = corners.b - corners.a;
    PRECISE vec3 edge2 = corners.c - corners.a;
    PRECISE vec3 along1 = edge1 * uv.x;
    PRECISE vec3 along2 = edge2 * uv.y;
    PRECISE vec3 inside = along1 + along2;
    PRECISE vec3 position_object = corners.a + inside;

    SurfacePoint point;
    point.position = transform_point(placement.to_world, position_object);
    // Scaled by a power of two, or tiny triangles would underflow in the product.
    float scale = power_of_two_below(max(largest_entry(edge1), largest_entry(edge2)));
    point.normal_object = normalize(cross_precise(edge1 / scale, edge2 / scale));
    vec3 normal = transposed_times(placement.to_object, point.normal_object);
    float stretch = length(normal);
    point.normal = normal / stretch;

    float extent = largest_entry(abs(edge1) + abs(edge2) + abs(edge1 - edge2));
    vec3 error_world = magnitude_vector(placement.to_world, position_object) * (3.0f * HALF_ULP) +
                       magnitude_offset(placement.to_world) * (2.0f * HALF_ULP);
    point.error_object = abs(corners.a) * HALF_ULP + extent * (3.0f * HALF_ULP) +
                         (magnitude_vector(placement.to_object, point.position) +
                          magnitude_offset(placement.to_object)) * (2.0f * HALF_ULP);
    point.offset = SPAWN_MARGIN * (dot(error_world, abs(point.normal)) +
                                   dot(point.error_object, abs(point.normal_object)) / stretch);
    return point;
}

// Where a ray on the given side of the surface starts.
FUNC vec3 spawn_position(SurfacePoint point, bool is_front)
{
    return point.position + point.normal * (is_front ? point.offset : -point.offset);
}

// A t_min with which the ray goes on behind the triangle that it met at `t`: every accelerator finds that triangle
// before it, whatever its own t is within rounding.
FUNC float passing_t(SurfacePoint point, Placement placement, Ray ray, float t)
{
    vec3 error = point.error_object +
                 (magnitude_vector(placement.to_object, ray.origin) + magnitude_offset(placement.to_object) +
                  magnitude_vector(placement.to_object, ray.direction) * t) * (8.0f * HALF_ULP);
    vec3 direction = transform_vector(placement.to_object, ray.direction);
    float slack = dot(error, abs(point.normal_object)) / abs(dot(direction, point.normal_object));
    return (t + SPAWN_MARGIN * slack) * (1.0f + 8.0f * HALF_ULP);
}
#endif
