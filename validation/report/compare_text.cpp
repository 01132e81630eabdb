// SPDX-License-Identifier: MIT
#include "validation/report/compare_text.h"

#include <algorithm>
#include <iomanip>

#include "engine/core/error.h"
#include "validation/records/recorder.h"
#include "validation/report/verdict.h"
#include "validation/report/wording.h"

namespace twinray::report {
namespace {

std::string_view word_of(Change::Kind kind) {
    switch (kind) {
        case Change::Kind::worse: return "worse";
        case Change::Kind::better: return "better";
        case Change::Kind::slower: return "slower";
        case Change::Kind::faster: return "faster";
    }
    return "";
}

}  // namespace

NamedReport read_report(const std::filesystem::path& path) {
    const std::filesystem::path file = std::filesystem::is_directory(path) ? path / "report.jsonl" : path;
    NamedReport report{path.string(), read_json_lines(file).records};
    if (report.records.empty()) fail("report '", file.string(), "' has no record of `twinray report`");
    return report;
}

void print_side_by_side(std::ostream& out, std::span<const NamedReport> reports) {
    for (const NamedReport& report : reports) {
        const Record& first = report.records.front();
        out << report.name << ": " << first.device.name << ", " << first.device.driver << "; twinray " << first.git
            << ", " << first.run << "\n  " << verdict_of(report.records).headline << '\n';
        for (const Finding& finding : findings_of(report.records))
            if (finding.faults)
                out << "    " << std::left << std::setw(12) << finding.backend << name_of(finding.mistake) << ": "
                    << rate_text(finding.faults, finding.n) << '\n';
    }
}

void print_comparison(std::ostream& out, const Comparison& comparison) {
    for (const Change& change : comparison.changes)
        out << "  " << word_of(change.kind) << ": " << change.what << ": " << change.how << '\n';
    for (const TimeRatio& time : comparison.times)
        out << "  times of " << std::left << std::setw(24) << time.backend + ' ' + time.level
            << with_interval(time.ratio, time.ratio_95, 3) << " over " << time.measurements << " measurements\n";
    out << "  all times together: " << number(comparison.drift, 3)
        << " times as long, which is taken out of those above\n  " << comparison.compared << " measurements compared, "
        << comparison.only_before << " only before, " << comparison.only_now << " only now; " << comparison.tests
        << " tests, which report a change where there is none in " << number(100 * false_alarms)
        << " % of comparisons at most\n  "
        << (comparison.has_one_seed
                ? ""
                : "their seeds differ, and so do their scenes: rates are compared over all cases together\n  ")
        << (comparison.is_worse()        ? "verdict: worse"
            : comparison.changes.empty() ? "verdict: no change beyond noise"
                                         : "verdict: changed, and nothing is worse")
        << '\n';
}

}  // namespace twinray::report
