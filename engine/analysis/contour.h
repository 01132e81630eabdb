// SPDX-License-Identifier: MIT
// The exchange of two polygons that see all of each other, by Stokes' theorem: a pure function.
#pragma once

#include <cstdint>

#include "engine/analysis/polygon64.h"

namespace twinray {

struct ContourExchange {
    double flow = 0;                // A F, from either to the other
    double error = 0;               // bound of the errors of the quadrature and of rounding
    std::uint64_t evaluations = 0;  // of ln r along an edge
};

// Returns A F = 1 / (2 pi) of the integral of ln r dr_a . dr_b along both contours (Sparrow, "A new and simpler
// formulation for radiative angle factors", 1963). For two edges it is taken in closed form along the longer one; along
// the other by a pair of rules of Gauss and Kronrod on pieces that are halved until both agree within rounding, which
// also finds the logarithms at vertices and edges that polygons share. Each polygon is on the front side of the other's
// plane, see facing_parts(); edges may be as short as the remains of a vertex after that.
ContourExchange contour_exchange(const Polygon64& a, const Polygon64& b);

}  // namespace twinray
