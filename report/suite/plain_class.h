// SPDX-License-Identifier: MIT
// Classes of triangles by signs of plain arithmetic, with which exact arithmetic is compared.
#pragma once

#include "engine/collide/pair_class.h"

namespace twinray::suite {

PairClass class_by_float32(const WorldTriangle& a, const WorldTriangle& b);
PairClass class_by_float64(const WorldTriangle& a, const WorldTriangle& b);

// Returns the sign of det(a - d, b - d, c - d).
template <class Real>
int plain_volume_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    using Vector = Vec<3, Real>;
    const Vector from(d);
    const Real volume = dot(Vector(a) - from, cross(Vector(b) - from, Vector(c) - from));
    return (volume > 0) - (volume < 0);
}

// Returns the sign of det(a - c, b - c) as seen along an axis.
template <class Real>
int plain_area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis) {
    using Vector = Vec<3, Real>;
    const Vector from(c);
    const Real area = cross(Vector(a) - from, Vector(b) - from)[static_cast<int>(axis)];
    return (area > 0) - (area < 0);
}

}  // namespace twinray::suite
