// SPDX-License-Identifier: MIT
// Classes of triangles without error: the signs that float64 leaves open are computed by expansions of doubles.
#pragma once

#include "engine/collide/pair_class.h"

namespace twinray {

// Exact for coordinates in the range of exact_sign.h.
PairClass exact_class(const Corners64& a, const Corners64& b);

// The same for triangles of meshes: those of one placed mesh that share vertices are separate unless they have more in
// common than these and the edge between two of them.
PairClass exact_class(const Corners64& a, const TriangleName& a_name, const Corners64& b, const TriangleName& b_name);

// Where the insides of two triangles of class crossing meet: the two ends of it, which are one where a triangle without
// area stands for a segment. Coordinates are off by at most 2^-49 of the largest coordinate of a corner in magnitude.
struct ContactSegment {
    dvec3 from, to;
};
ContactSegment crossing_segment(const Corners64& a, const Corners64& b);

}  // namespace twinray
