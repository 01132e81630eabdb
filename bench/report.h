// Results as tables for people and as JSON for scripts.
#pragma once

#include <nlohmann/json.hpp>

#include <ostream>

#include "bench/measure.h"
#include "bench/scenes.h"

namespace twinray::bench {

inline constexpr const char* record_schema = "twinray-bench/1";

// The measurements: the builds of each backend, and its traces of one set of rays.
struct Results {
    const BenchScene& scene;
    const LineUp& line_up;
    std::span<const BuildRounds> builds;
};

void print_builds(std::ostream& out, const Results& results);
void print_traces(std::ostream& out, const Results& results, std::string_view title,
                  std::span<const TraceRounds> traces);

// Writes a record for each backend, added to the fields of `base`. Values that were not measured are null.
using RecordSink = std::function<void(const nlohmann::json&)>;
void record_traces(const RecordSink& record_one, const nlohmann::json& base, const Results& results, RayKind kind,
                   std::span<const TraceRounds> traces);

// Statistics of rounds, and columns of text: pure functions.

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
