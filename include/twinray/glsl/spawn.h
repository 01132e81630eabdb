// SPDX-License-Identifier: MIT
// Points on triangles from which rays start without hitting their own triangle, and without an absolute epsilon: a
// bound of all rounding errors between the triangle and the ray as an accelerator sees it, in the manner of Bitterli et
// al., "Self-Intersection Avoidance", NVIDIA 2023.
//
//     SurfacePoint point = surface_point(placement, vertices, vec2(hit.u, hit.v));
//     ray.origin = spawn_position(point, dot(ray.direction, point.normal) > 0.0);
//     ray.t_min = 0.0;
//
// With u = 2^-24, half a unit in the last place of 1, to first order and by component, the bound adds up
//  - in object space the roundings of the point (u of itself, 3 u of the way from the first corner), and of the
//    triangle test (TEST_ERROR of the triangle's extent);
//  - in world space those of the map (3 u of |M| |p|, u of the sum) and of adding the offset (u);
//  - those of an accelerator's way back (INVERSE_ERROR). It inverts M itself: W is wrong by some u |W| |M| |W|, which
//    is |W| for scales and translations and more where an inverse is hard. The largest of 1.5 * 10^6 placements of
//    condition up to 10^3, in units of u |W| |M| |W| (|P| + |t|): 3.2 for twinray's inverse, 4.1 for plain float32
//    cofactors. tests/shared/spawn_test.cpp holds the whole bound against both.
// It holds for meshes of 2^-60 to 2^60 under instances that keep world coordinates within 2^-100 to 2^100. It cannot
// hold for hardware whose inverse has a larger error than INVERSE_ERROR; case F02 of `twinray report` tests that.
#ifndef TWINRAY_SPAWN_H
#define TWINRAY_SPAWN_H
#include "twinray/glsl/instance.h"
#include "twinray/glsl/surface_point.h"
#include "twinray/glsl/transform.h"
#include "twinray/glsl/triangle.h"

const float TEST_ERROR = 4.0f * HALF_ULP;
const float INVERSE_ERROR = 5.0f * HALF_ULP;

// The placement of an instance in the world.
struct Placement {
    Rows to_world;
    Rows to_object;  // its inverse
};

// The vertices of a triangle in object space.
struct TriangleVertices {
    vec3 a;
    vec3 b;
    vec3 c;
};

// Makes a placement from an invertible map to world space.
FUNC Placement placement_of(Rows to_world) {
    Placement placement;
    placement.to_world = to_world;
    placement.to_object = inverse_of(to_world);
    return placement;
}

// Makes it for an instance on the device, such as in AbstractAccel::instance_buffer().
FUNC Placement placement_of(InstanceRecord instance) { return placement_of(to_world_of(instance)); }

// positions: 3 tightly packed floats per vertex. indices: 3 per triangle.
FUNC TriangleVertices vertices_of(Floats positions, Uints indices, uint primitive_index) {
    TriangleVertices vertices;
    uvec3 places = load_indices(indices, primitive_index);
    vertices.a = load_position(positions, places.x);
    vertices.b = load_position(positions, places.y);
    vertices.c = load_position(positions, places.z);
    return vertices;
}

// Returns the first three components.
FUNC vec3 xyz(vec4 v) { return vec3(v.x, v.y, v.z); }
// Returns the image of the origin: the map's fourth column.
FUNC vec3 offset_of(Rows m) { return vec3(m.r0.w, m.r1.w, m.r2.w); }

// Returns |m| |v|, without m's offset: the scale of the rounding errors of the product.
FUNC vec3 magnitude(Rows m, vec3 v) {
    return vec3(dot(abs(xyz(m.r0)), abs(v)), dot(abs(xyz(m.r1)), abs(v)), dot(abs(xyz(m.r2)), abs(v)));
}

// Returns m's linear part, transposed, times v: with a map's inverse it transforms normals as the map does points.
FUNC vec3 transposed_times(Rows m, vec3 v) { return xyz(m.r0) * v.x + xyz(m.r1) * v.y + xyz(m.r2) * v.z; }

// Returns a bound of the error that an accelerator's own inverse and the product with it add to a vector of this size
// in world space.
FUNC vec3 inverse_error(Placement placement, vec3 size) {
    vec3 back = magnitude(placement.to_object, size);
    return magnitude(placement.to_object, magnitude(placement.to_world, back)) * INVERSE_ERROR;
}

// Scales by a power of two first, so that squares stay within float32.
FUNC float scaled_length(vec3 v) {
    float scale = power_of_two_below(largest_entry(v));
    return scale == 0.0f ? 0.0f : length(v / scale) * scale;
}

// Returns the least of the three heights of a triangle with these edges from one corner, in their unit; 0 if it is a
// point.
FUNC float least_height(vec3 edge1, vec3 edge2) {
    float scale = power_of_two_below(max(largest_entry(edge1), largest_entry(edge2)));
    if (scale == 0.0f) return 0.0f;
    edge1 = edge1 / scale;
    edge2 = edge2 / scale;
    float longest = max(max(length(edge1), length(edge2)), length(edge1 - edge2));
    return length(cross_precise(edge1, edge2)) / longest * scale;
}

// Returns the point (1-u-v) a + u b + v c, as a + (u (b - a) + v (c - a)): the corner is added last, so that only one
// rounding has the size of the coordinates. 0 <= u, v and u + v <= 1 but for rounding. A triangle without area has no
// normal: its point is NaN.
FUNC SurfacePoint surface_point(Placement placement, TriangleVertices vertices, vec2 uv) {
    PRECISE vec3 edge1 = vertices.b - vertices.a;
    PRECISE vec3 edge2 = vertices.c - vertices.a;
    PRECISE vec3 along1 = edge1 * uv.x;
    PRECISE vec3 along2 = edge2 * uv.y;
    PRECISE vec3 inside = along1 + along2;
    PRECISE vec3 position_object = vertices.a + inside;

    SurfacePoint point;
    point.position = transform_point(placement.to_world, position_object);
    float scale = power_of_two_below(max(largest_entry(edge1), largest_entry(edge2)));
    point.normal_object = normalize(cross_precise(edge1 / scale, edge2 / scale));
    vec3 normal = transposed_times(placement.to_object, point.normal_object);
    float stretch = scaled_length(normal);
    point.normal = normal / stretch;
    point.feature =
        least_height(transform_vector(placement.to_world, edge1), transform_vector(placement.to_world, edge2));

    float extent = largest_entry(abs(edge1) + abs(edge2) + abs(edge1 - edge2));
    vec3 error_world = (magnitude(placement.to_world, position_object) * 3.0f + abs(point.position) * 2.0f) * HALF_ULP;
    point.error_object = (abs(position_object) + (abs(along1) + abs(along2)) * 3.0f) * HALF_ULP + extent * TEST_ERROR +
                         inverse_error(placement, abs(point.position) + abs(offset_of(placement.to_world)));
    point.offset = dot(error_world, abs(point.normal)) + dot(point.error_object, abs(point.normal_object)) / stretch;
    return point;
}

// Returns the start of a ray on the given side of the surface. The ray's t_min is 0.
FUNC vec3 spawn_position(SurfacePoint point, bool is_front) {
    PRECISE vec3 position = point.position + point.normal * (is_front ? point.offset : -point.offset);
    return position;
}

// Returns a t_min with which the ray continues behind the triangle that it hit at `t`: every accelerator finds that
// triangle before it, whatever its own t is within rounding.
FUNC float passing_t(SurfacePoint point, Placement placement, Ray ray, float t) {
    vec3 error = point.error_object + inverse_error(placement, abs(ray.origin) + abs(offset_of(placement.to_world))) +
                 inverse_error(placement, ray.direction) * t;
    vec3 direction = transform_vector(placement.to_object, ray.direction);
    float slack = dot(error, abs(point.normal_object)) / abs(dot(direction, point.normal_object));
    return (t + slack) * (1.0f + 8.0f * HALF_ULP);
}
#endif
