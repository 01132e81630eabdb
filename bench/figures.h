// SPDX-License-Identifier: MIT
// What rounds come to: pure functions.
#pragma once

#include <optional>
#include <span>

#include "bench/line_up.h"
#include "bench/measure.h"

namespace twinray::bench {

struct Spread {
    double median = 0, min = 0, max = 0;
};
// `values` must not be empty.
Spread spread_of(std::span<const double> values);

// Millions of rays a second.
Spread mrays_per_s(const TraceRounds& rounds);

// Median over the rounds of how many times as fast it was as the baseline in the same round.
double speed_up(const TraceRounds& rounds, const TraceRounds& baseline);
// Nothing where the baseline does not run.
std::optional<double> speed_up(const LineUp& line_up, std::span<const TraceRounds> all, std::size_t index,
                               Baseline baseline);

// y = offset + slope * x, by least squares.
struct Line {
    double offset = 0, slope = 0;
};
// `x` and `y` are equally long and hold two different x at least.
Line fit_line(std::span<const double> x, std::span<const double> y);

}  // namespace twinray::bench
