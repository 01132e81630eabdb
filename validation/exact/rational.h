// SPDX-License-Identifier: MIT
// Vectors of rational numbers, in which sums, products and quotients of floats are exact.
#pragma once

#include <gmpxx.h>

#include "twinray/glsl/cpp.h"

namespace twinray::exact {

using Rational = mpq_class;

struct Vector {
    Rational x, y, z;

    const Rational& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

// Takes finite numbers.
inline Vector vector_of(const dvec3& v) { return {v.x, v.y, v.z}; }

inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Rational dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Returns the nearest double; ties go to the even one.
double rounded(const Rational& value);

}  // namespace twinray::exact
