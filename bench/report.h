// SPDX-License-Identifier: MIT
// Results as tables for people and as JSON for scripts.
#pragma once

#include <nlohmann/json.hpp>

#include <ostream>
#include <span>

#include "bench/figures.h"
#include "bench/rays.h"

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

// Returns a record for each backend, added to the fields of `base`. Values that were not measured are null.
std::vector<nlohmann::json> records_of(const nlohmann::json& base, const Results& results, RayKind kind,
                                       std::span<const TraceRounds> traces);

}  // namespace twinray::bench
