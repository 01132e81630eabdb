// SPDX-License-Identifier: MIT
// The results so far of rays between points of faces, for their exchange: pure functions.
#pragma once

#include <span>

#include "engine/analysis/estimate.h"

namespace twinray {

class PairSums {
  public:
    // Adds a chunk of rays (see shaders/analysis/pair_rays.h): the exchange by each if it were the only one, before
    // `unit`; negative if it is blocked.
    void add(std::span<const float> weights, double unit);

    std::uint64_t rays() const { return rays_; }
    // Returns the mean, with the 95 % interval of Student's distribution for the scatter of the replicates. If an
    // obstacle is possible, but fewer than 10 rays are blocked, or fewer than 10 free, replicates are too few to tell:
    // the interval then has room for the rate of Clopper and Pearson, of rays as heavy as the heaviest.
    Estimate exchange(bool may_be_blocked) const;

  private:
    Estimate scattered_of(Replicates sums) const;

    Replicates all_ = {}, free_ = {};
    std::uint64_t rays_ = 0, free_count_ = 0, blocked_count_ = 0;
    double lightest_free_ = 0, heaviest_ = 0;
};

}  // namespace twinray
