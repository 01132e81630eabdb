// SPDX-License-Identifier: MIT
// Affine maps in float64: the inverse of an instance's map, and its error.
#ifndef TWINRAY_SHARED_TRANSFORM_DOUBLE_H
#define TWINRAY_SHARED_TRANSFORM_DOUBLE_H
#include "shaders/shared/exact_double.h"
#include "twinray/glsl/transform.h"

struct RowsDouble {
    dvec4 r0;
    dvec4 r1;
    dvec4 r2;
};

FUNC dvec3 linear_double(vec4 row) { return dvec3(double(row.x), double(row.y), double(row.z)); }
FUNC dvec3 linear_double(dvec4 row) { return dvec3(row.x, row.y, row.z); }

FUNC dvec3 transform_vector_double(RowsDouble m, dvec3 v) {
    return dvec3(product_sum(linear_double(m.r0), v), product_sum(linear_double(m.r1), v),
                 product_sum(linear_double(m.r2), v));
}
FUNC dvec3 offset_double(RowsDouble m) { return dvec3(m.r0.w, m.r1.w, m.r2.w); }

FUNC RowsDouble absolute(RowsDouble m) {
    RowsDouble magnitudes;
    magnitudes.r0 = abs(m.r0);
    magnitudes.r1 = abs(m.r1);
    magnitudes.r2 = abs(m.r2);
    return magnitudes;
}

FUNC float largest_entry_double(dvec3 v) { return float(max(abs(v.x), max(abs(v.y), abs(v.z)))); }

// Returns the inverse of an invertible map of float32 entries: cofactors, with exact products, over the determinant.
FUNC RowsDouble inverse_double(Rows m) {
    dvec3 a0 = linear_double(m.r0);
    dvec3 a1 = linear_double(m.r1);
    dvec3 a2 = linear_double(m.r2);
    dvec3 x = cross_product(a1, a2);
    dvec3 y = cross_product(a2, a0);
    dvec3 z = cross_product(a0, a1);
    double det = product_sum(a0, x);
    x = x / det;
    y = y / det;
    z = z / det;
    dvec3 offset = dvec3(double(m.r0.w), double(m.r1.w), double(m.r2.w));
    dvec3 row0 = dvec3(x.x, y.x, z.x);
    dvec3 row1 = dvec3(x.y, y.y, z.y);
    dvec3 row2 = dvec3(x.z, y.z, z.z);
    RowsDouble inverse;
    inverse.r0 = dvec4(row0.x, row0.y, row0.z, -product_sum(row0, offset));
    inverse.r1 = dvec4(row1.x, row1.y, row1.z, -product_sum(row1, offset));
    inverse.r2 = dvec4(row2.x, row2.y, row2.z, -product_sum(row2, offset));
    return inverse;
}

// Returns the sum of a row of |W m - 1|, where `row` is that of W and `unit` of 1.
FUNC double residual_row(dvec4 row, dvec3 unit, Rows m) {
    dvec3 product = row.x * linear_double(m.r0) + row.y * linear_double(m.r1) + row.z * linear_double(m.r2) - unit;
    return abs(product.x) + abs(product.y) + abs(product.z);
}

// Returns the largest row sum of |inverse m - 1|: the relative error of vectors that the inverse maps.
FUNC double residual_of(RowsDouble inverse, Rows m) {
    return max(residual_row(inverse.r0, dvec3(1.0f, 0.0f, 0.0f), m),
               max(residual_row(inverse.r1, dvec3(0.0f, 1.0f, 0.0f), m),
                   residual_row(inverse.r2, dvec3(0.0f, 0.0f, 1.0f), m)));
}
#endif
