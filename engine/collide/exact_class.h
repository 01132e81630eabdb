// SPDX-License-Identifier: MIT
// Classifies triangles without error: the signs that float64 leaves open are computed by expansions of doubles.
#pragma once

#include "engine/collide/pair_class.h"

namespace twinray {

// Returns the class; exact for coordinates in the range of exact_sign.h.
PairClass exact_class(const WorldTriangle& a, const WorldTriangle& b);

// The same for triangles of meshes: two of one run that share vertices are separate unless they have more in common
// than these and the edge between two of them.
PairClass exact_class(const WorldTriangle& a, const TriangleName& a_name, const WorldTriangle& b,
                      const TriangleName& b_name);

// Needs two triangles of class crossing.
ContactSegment crossing_segment(const WorldTriangle& a, const WorldTriangle& b);

}  // namespace twinray
