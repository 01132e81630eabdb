// The page of a report: verdict first, then the plots that matter, then everything else, folded.
#pragma once

#include <utility>

#include "report/page/compare.h"
#include "report/page/figure.h"
#include "report/suite/suite.h"

namespace twinray::report {

struct PageInput {
    std::string suite;   // "quick"
    double seconds = 0;  // how long it took
    std::span<const frame::Case> catalogue;
    std::span<const Record> records;
    std::string baseline = {};             // file for comparison; "" = none
    std::span<const Change> changes = {};  // since the baseline
    // The drawn figures, each as an <svg> element; "" without gnuplot.
    std::vector<std::pair<Figure, std::string>> figures = {};
    std::vector<std::string> reproducers = {};  // classes of faults, each with a folder in reproducers/
};

// Returns one page of HTML that is also XML, needs no script, and refers only to the files beside it that it links.
std::string page(const PageInput& input);
// Throws Error naming the file.
void write_page(const std::filesystem::path& file, const PageInput& input);

// Parts of it, in case_tables.cpp.
// Writes a row for each accelerator, level and variant of a case, over all its settings; the file of records has these
// apart.
void write_case_tables(std::ostream& out, const PageInput& input);
// Writes the cases that were not run, grouped by reason.
void write_not_run(std::ostream& out, const PageInput& input);

}  // namespace twinray::report
