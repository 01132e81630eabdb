// SPDX-License-Identifier: MIT
// Diffuse light or heat between faces: B = E + rho F B, where B is what leaves a group of faces by area, E what it
// emits and rho what it reflects of what arrives.
#pragma once

#include <span>
#include <vector>

#include "engine/analysis/view_factors.h"

namespace twinray {

struct Radiosity {
    std::vector<double> values;    // B, in the unit of emission
    std::vector<double> incident;  // F B: what arrives by area
    double relative_residual = 0;  // |E + rho F B - B| over |B|, largest entries
    double amplification = 0;      // largest row sum of (I - rho F)^-1: 1 / (1 - rho) in a closed room of one rho
    double forward_error = 0;      // bound of the largest |B - B_exact| over the largest |B|, for this F
    std::vector<double> sampling;  // half the 95 % interval of B by that of F, to first order; see below
    int iterations = 0;            // of the solver, for B
};

// `rows` are all rows of a matrix, in order; emission and reflectance have one entry a row, emission finite,
// reflectance in [0, 1]. Rows without rays keep B = E. Solved by BiCGSTAB in float64 and refined until the residual is
// below `tolerance`; throws Error where it does not get there, as for a closed room that reflects everything, and for
// wrong sizes or values.
//
// I - rho F has a non-negative inverse, so that its largest row sum, the solution for E = 1, bounds what it makes of
// the residual: `forward_error` is that product. `sampling` is the inverse times the standard deviations of rho F B,
// taken as if all rows erred the same way at once: an upper bound, as rows are estimated independently.
Radiosity solve_radiosity(const std::vector<ViewFactorRow>& rows, std::span<const double> emission,
                          std::span<const double> reflectance, double tolerance = 1e-13);

}  // namespace twinray
