// SPDX-License-Identifier: MIT
// The vertices of an instance's triangles in world space, as collisions define them: from float32 positions p and rows
// r, ((r.x p.x + r.y p.y) + r.z p.z) + r.w in float64. The products are exact, each sum rounds to nearest. All are
// multiples of 2^-298 below 2^259, so that products of three differences, and their rounding errors, neither over- nor
// underflow float64.
#ifndef TWINRAY_COLLIDE_WORLD_VERTEX_H
#define TWINRAY_COLLIDE_WORLD_VERTEX_H
#include "shaders/collide/pair_class.h"
#include "shaders/shared/transform_double.h"

FUNC double world_coordinate(vec4 row, dvec3 p) {
    PRECISE double x = product_sum(dvec3(widened(row.x), widened(row.y), widened(row.z)), p) + widened(row.w);
    return x;
}

FUNC dvec3 world_vertex(TriangleRun run, uint vertex) {
    Floats positions = run.placed.mesh.positions;
    dvec3 given = dvec3(widened(AT(positions, 3u * vertex)), widened(AT(positions, 3u * vertex + 1u)),
                        widened(AT(positions, 3u * vertex + 2u)));
    PRECISE dvec3 p = given * double(run.scale);
    Rows rows = run.placed.object_to_world;
    return dvec3(world_coordinate(rows.r0, p), world_coordinate(rows.r1, p), world_coordinate(rows.r2, p));
}

FUNC uvec3 indices_of(TriangleRun run, uint primitive) {
    Uints indices = run.placed.mesh.indices;
    return uvec3(AT(indices, 3u * primitive), AT(indices, 3u * primitive + 1u), AT(indices, 3u * primitive + 2u));
}

FUNC WorldTriangle world_triangle(TriangleRun run, uvec3 indices) {
    WorldTriangle triangle;
    triangle.a = world_vertex(run, indices.x);
    triangle.b = world_vertex(run, indices.y);
    triangle.c = world_vertex(run, indices.z);
    return triangle;
}

// Returns a float not above x, and the largest such one but for denormals.
FUNC float float_below(double x) {
    const float LARGEST = 3.402823466e38f;
    const float LEAST_NORMAL = 1.17549435082e-38f;
    if (x > double(LARGEST)) return LARGEST;
    if (x < -double(LARGEST)) return uintBitsToFloat(0xff800000u);
    if (abs(x) < double(LEAST_NORMAL)) return x < double(0.0f) ? -LEAST_NORMAL : 0.0f;
    double rounded = rounded_to_24_bits(x);
    return rounded > x ? next_below(float(rounded)) : float(rounded);
}

FUNC vec3 floats_below(dvec3 p) { return vec3(float_below(p.x), float_below(p.y), float_below(p.z)); }

// Returns whether no coordinate is infinite or NaN.
FUNC bool is_finite_point(dvec3 p) {
    const double LARGEST =
        double(3.402823466e38f) * double(3.402823466e38f) * double(4.0f);  // above any that is finite
    return abs(p.x) < LARGEST && abs(p.y) < LARGEST && abs(p.z) < LARGEST;
}

// The box is empty if a vertex is not finite.
FUNC TreeBox box_around(WorldTriangle t, uint item, uint group) {
    TreeBox box = empty_tree_box();
    if (!is_finite_point(t.a) || !is_finite_point(t.b) || !is_finite_point(t.c)) return box;
    box.min = floats_below(min(t.a, min(t.b, t.c)));
    box.max = -floats_below(-max(t.a, max(t.b, t.c)));
    box.item = item;
    box.group = group;
    return box;
}
#endif
