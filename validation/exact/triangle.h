// SPDX-License-Identifier: MIT
// A line against a triangle, decided and computed exactly.
#pragma once

#include <array>
#include <optional>

#include "validation/exact/rational.h"
#include "validation/reference/triangle64.h"

namespace twinray::exact {

// The points origin + t direction.
struct Line {
    Vector origin, direction;
};

// The part of a closed triangle that a line meets: its inside, an edge but no vertex, or a vertex.
enum class Incidence : std::uint8_t { interior, edge, vertex };

struct Crossing {
    Rational t;     // in units of the line's direction
    Rational u, v;  // the point is (1-u-v) v0 + u v1 + v v2
    Incidence incidence = Incidence::interior;
    bool along = false;  // the normal (v1 - v0) x (v2 - v0) points along the line
};

// Returns six times the signed volumes of (direction, b, c), (direction, c, a) and (direction, a, b), vertices a, b, c
// seen from the origin: the weights of the vertices, times a common factor. The line meets the triangle where they have
// one sign; one that is 0 puts the line on the edge across from its vertex; all 0: the plane contains the line.
std::array<Rational, 3> edge_values(const Line& line, const Triangle64& triangle);

// Returns nothing if the line passes the triangle or lies in its plane. t may be negative.
std::optional<Crossing> crossing(const Line& line, const Triangle64& triangle);

}  // namespace twinray::exact
