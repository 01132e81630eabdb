// SPDX-License-Identifier: MIT
// Signs of volumes and areas without error: those that float64 leaves open are computed by expansions of doubles.
// Coordinates must be 0 or of a magnitude from 2^-245 to 2^259, as those of world_vertex.h are: then no operation over-
// or underflows.
#pragma once

#include "engine/collide/expansion.h"
#include "engine/collide/pair_class.h"

namespace twinray {

#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/orient.h"
#include "twinray/glsl/cpp_end.h"

// det(a - d, b - d, c - d), and its sign: 1 where d sees a, b, c turn clockwise.
Expansion volume_of(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
int volume_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
// Of det(a - c, b - c) as seen along an axis: 1 where a, b, c turn anticlockwise.
int area_sign(const dvec3& a, const dvec3& b, const dvec3& c, uint axis);

// Why signs of these coordinates may be wrong, "" if they are right.
std::string sign_fault_of(const dvec3& point);

}  // namespace twinray
