// SPDX-License-Identifier: MIT
// Intervals of statistics that have no formula.
#pragma once

#include <functional>
#include <span>

#include "engine/core/statistics.h"

namespace twinray {

// Returns the 95 % percentile interval (Efron, "Bootstrap Methods", 1979) of a statistic of n independent items: 1000
// times, n items are drawn with replacement, and `statistic` gets their indices. The same seed gives the same interval.
// It covers less than it says if the items are few: from 10 on it is fair. n is at least 1.
Interval bootstrap_interval_95(std::size_t n,
                               const std::function<double(std::span<const std::size_t> items)>& statistic,
                               std::uint64_t seed = 1);

}  // namespace twinray
