// SPDX-License-Identifier: MIT
// What two groups of faces exchange, and who tells it.
#pragma once

#include <array>
#include <string_view>

#include "twinray/glsl/cpp.h"

namespace twinray {

enum class PairEstimator : uint {
    automatic,  // contours for what nothing can come between, areas for what is far for its size, else hits
    hits,       // what the rays of a row meet
    area,       // rays between points of both faces
    contour,    // integrals along both contours
};
inline constexpr std::array all_pair_estimators = {PairEstimator::automatic, PairEstimator::hits, PairEstimator::area,
                                                   PairEstimator::contour};
constexpr std::string_view name_of(PairEstimator estimator) {
    constexpr std::array<std::string_view, 4> names = {"auto", "hits", "area", "contour"};
    return names[static_cast<std::size_t>(estimator)];
}

// A_i F_ij = A_j F_ji of groups i <= j, with its 95 % interval.
struct KnownExchange {
    uint i, j;
    double flow, low, high;
    PairEstimator by;  // area where anything of it is by areas
};

}  // namespace twinray
