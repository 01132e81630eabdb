// SPDX-License-Identifier: MIT
// Statistics of rounds, and columns of text: pure functions.
#pragma once

#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "bench/line_up.h"
#include "bench/measure.h"

namespace twinray::bench {

struct Spread {
    double median = 0, min = 0, max = 0;
};
// `values` must not be empty.
Spread spread_of(std::span<const double> values);

// Returns millions of rays per second.
Spread mrays_per_s(const TraceRounds& rounds);

// Returns the median over the rounds of how many times as fast as the baseline it was in the same round.
double speed_up(const TraceRounds& rounds, const TraceRounds& baseline);
// Returns nothing if the baseline does not run.
std::optional<double> speed_up(const LineUp& line_up, std::span<const TraceRounds> all, std::size_t index,
                               Baseline baseline);

// y = offset + slope * x, by least squares.
struct Line {
    double offset = 0, slope = 0;
};
// `x` and `y` are equally long and hold two different x at least.
Line fit_line(std::span<const double> x, std::span<const double> y);

// Prints rows with equal numbers of cells; the first is the heading. The first column is flush left, all others right.
void print_table(std::ostream& out, const std::vector<std::vector<std::string>>& rows);

std::string fixed_text(double value, int decimals);
// Returns so many significant digits and no power of ten: 3 give "1234", "12.3", "0.00123"; "-" unless finite.
std::string number_text(double value, int digits);

}  // namespace twinray::bench
