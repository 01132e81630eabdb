// SPDX-License-Identifier: MIT
// How well float32 inverts the map of an instance, which bounds how far a ray in object space is off.
#ifndef TWINRAY_SHARED_RESIDUAL_H
#define TWINRAY_SHARED_RESIDUAL_H
#include "shaders/shared/refine.h"
#include "shaders/shared/transform.h"

FUNC dvec3 linear_double(vec4 row) { return dvec3(double(row.x), double(row.y), double(row.z)); }

// One row of |inverse map - 1|: the sum over its linear part; in `offset`, what it adds to the origin.
FUNC double residual_row(vec4 row, dvec3 unit, Rows to_world, INOUT(double) offset)
{
    dvec3 m0 = linear_double(to_world.r0);
    dvec3 m1 = linear_double(to_world.r1);
    dvec3 m2 = linear_double(to_world.r2);
    dvec3 w = linear_double(row);
    dvec3 product = w.x * m0 + w.y * m1 + w.z * m2 - unit;
    offset = abs(product_sum(w, dvec3(double(to_world.r0.w), double(to_world.r1.w), double(to_world.r2.w))) + double(row.w));
    return abs(product.x) + abs(product.y) + abs(product.z);
}

// Notes how well float32 inverts the instance's map.
FUNC RefineInstance with_residual(RefineInstance instance, Rows to_world)
{
    const float UP = 1.00000095367431640625f; // 1 + 2^-20: more than rounding to float32 takes
    Rows inverse = inverse_of(to_world);
    double x = double(0.0f);
    double y = double(0.0f);
    double z = double(0.0f);
    double row_x = residual_row(inverse.r0, dvec3(1.0f, 0.0f, 0.0f), to_world, x);
    double row_y = residual_row(inverse.r1, dvec3(0.0f, 1.0f, 0.0f), to_world, y);
    double row_z = residual_row(inverse.r2, dvec3(0.0f, 0.0f, 1.0f), to_world, z);
    instance.residual = float(max(row_x, max(row_y, row_z))) * UP;
    instance.offset_residual = float(max(x, max(y, z))) * UP;
    dvec3 normal = cross_product(linear_double(to_world.r0), linear_double(to_world.r1));
    instance.is_mirrored = product_sum(normal, linear_double(to_world.r2)) < double(0.0f) ? 1u : 0u;
    return instance;
}
#endif
