// SPDX-License-Identifier: MIT
// The page of a report.
#pragma once

#include "validation/report/baseline.h"
#include "validation/report/plots.h"
#include "validation/suite/suite.h"

namespace twinray::report {

struct PageInput {
    std::string suite;  // "quick"
    std::span<const suite::SuiteCase> catalogue;
    std::span<const Record> records;
    std::string baseline;  // file that was compared to; "" = none
    std::span<const Change> changes;
};

// "pass", "fault of twinray", "fault of driver", "measured" or "not run".
std::string result_of(const Record& record);

// Records that show a fault of ours: where there is one the command exits with 1.
std::size_t faults_of_ours(std::span<const Record> records);

// How many ns a ray of a level costs over watertight on the same accelerator, worlds and rays: the median and range of
// the ratios over all that both ran.
struct LevelPrice {
    std::string backend, level;
    double median = 1, low = 1, high = 1;
    std::size_t measurements = 0;
    std::optional<double> worst_p99;  // of ErrorFigures::p99, over the same
};
std::vector<LevelPrice> level_prices(std::span<const Record> records);

// One page of HTML that is XML, too, and refers to nothing outside of itself but the replays that it links.
std::string page(const PageInput& input);
// Throws Error naming the file.
void write_page(const std::filesystem::path& file, const PageInput& input);

}  // namespace twinray::report
