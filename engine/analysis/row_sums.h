// SPDX-License-Identifier: MIT
// The hits so far of the rays of one row of view factors.
#pragma once

#include <span>
#include <vector>

#include "engine/analysis/estimate.h"
#include "twinray/glsl/cpp.h"

namespace twinray {

class RowSums {
  public:
    struct Entry {
        uint target;
        std::uint64_t hits;
        Replicates sums;  // of weights
    };

    // Adds a chunk of rays (see shaders/analysis/view_factors.h), each of which counts as `weight`. Order does not
    // matter but for rounding; weights that are powers of two do not round.
    void add(std::span<const uint> targets, double weight);
    // Merges the added chunks; the rest is then up to date.
    void settle();

    std::uint64_t rays() const { return rays_; }
    const std::vector<Entry>& entries() const { return entries_; }  // ascending by target
    // `total_weight`: of all rays of a replicate.
    Estimate estimate(const Entry& entry, double total_weight, FractionEstimator& estimator) const;

  private:
    struct Added {
        uint target;
        uint replicate;
        double weight;
    };
    std::vector<Added> added_;
    std::vector<Entry> entries_;
    std::uint64_t rays_ = 0;
};

}  // namespace twinray
