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
// Of each independent replicate of a sequence, all of them equally long: a sum, or a mean.
using Replicates = std::array<double, replicate_count>;

// What is known of a value that cannot be but within `possible`: neither it nor its interval leaves that, and the
// interval holds it.
Estimate within(const Interval& possible, double value, const Interval& interval_95);

// The mean of replicates, with Student's 95 % interval for their scatter.
Estimate scattered(const Replicates& values);

// Fractions in [0, 1] as the means of their replicates, `events` rays of `rays` in all. The interval is Student's for
// the scatter of the replicates, within [0, 1]; where fewer than 10 rays, or all but as many, had the event, replicates
// are too few to scatter as they should, and it is that of Clopper and Pearson (1934), which is never too short for
// independent rays, nor for stratified ones. No interval is shorter than what no ray may have seen, some 3.7 / rays
// either way: replicates of stratified rays can all agree. Those of counts take long to compute and are the same again
// and again: they are kept.
class Estimator {
  public:
    Estimate operator()(const Replicates& fractions, std::uint64_t events, std::uint64_t rays);

  private:
    const Interval& rate(std::uint64_t events, std::uint64_t rays);
    const Interval& counted(double value, std::uint64_t events, std::uint64_t rays);

    std::map<std::pair<std::uint64_t, std::uint64_t>, Interval> rates_;
};

}  // namespace twinray
