// SPDX-License-Identifier: MIT
// A fraction of rays with its error: pure functions.
#pragma once

#include <twinray/analysis.h>

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "engine/core/statistics.h"

namespace twinray {

inline constexpr std::size_t replicate_count = 16;
// A sum or a mean for each independent replicate of a sequence, all of them equally long.
using Replicates = std::array<double, replicate_count>;

// Restricts an estimate to the interval `possible`: neither the value nor its interval leaves that, and the interval
// holds the value.
Estimate within(const Interval& possible, double value, const Interval& interval_95);

// Returns the mean of replicates, with Student's 95 % interval for their scatter.
Estimate scattered(const Replicates& values);

// Estimates fractions in [0, 1] as the means of their replicates, `events` rays of `rays` in all. The interval is
// Student's for their scatter, within [0, 1]; if fewer than 10 rays, or all but as many, had the event, replicates are
// too few to scatter as they should, and it is that of Clopper and Pearson (1934), never too short for independent or
// stratified rays. No interval is shorter than some 3.7 / rays either way, which no ray may have seen: replicates of
// stratified rays can all agree. Intervals of counts take long to compute and recur: they are kept.
class FractionEstimator {
  public:
    Estimate operator()(const Replicates& fractions, std::uint64_t events, std::uint64_t rays);

  private:
    const Interval& rate(std::uint64_t events, std::uint64_t rays);
    const Interval& counted(double value, std::uint64_t events, std::uint64_t rays);

    std::map<std::pair<std::uint64_t, std::uint64_t>, Interval> rates_;
};

}  // namespace twinray
