// SPDX-License-Identifier: MIT
// What view factors obey whatever the scene: A_i F_ij = A_j F_ji, and each row's rays all end somewhere. How far
// estimates are from that, and the nearest that are not.
#pragma once

#include <vector>

#include "engine/analysis/view_factors.h"

namespace twinray {

struct ViewFactorResiduals {
    double reciprocity = 0;         // largest |A_i F_ij - A_j F_ji| over the largest area
    double reciprocity_scaled = 0;  // the same, over the smaller area of the two
    // The same difference in standard errors of it: the largest of those pairs of which at least 10 rays are expected
    // either way.
    double reciprocity_sigma = 0;
    double closure = 0;  // largest |1 - sum_j F_ij - open - back| of rows with an area
};

// `rows` are all, in order; areas are those of groups.
ViewFactorResiduals residuals_of(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas);

// The least change, in a sum of squares weighted by the inverse variance of each estimate, after which both hold: rows
// then have A_i F_ij = A_j F_ji but for rounding to float32, and add up to 1 with what is open or met a back side,
// which change, too. Entries of which only one direction was seen are completed. Intervals move with their values and
// keep their widths, which is more than they need. (Lawson, "Improving the accuracy of view factors by least squares
// smoothing", is the idea; the weights are the binomial variances here.) Throws Error where the solver does not
// converge.
void project(std::vector<ViewFactorRow>& rows, const std::vector<double>& areas);

}  // namespace twinray
