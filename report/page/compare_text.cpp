// SPDX-License-Identifier: MIT
#include "report/page/compare.h"

#include <iomanip>
#include <set>

#include "engine/core/error.h"
#include "report/page/verdict.h"
#include "report/page/wording.h"

namespace twinray::report {
namespace {

std::string_view word_of(Change::Kind kind) {
    constexpr std::array<std::string_view, 4> words = {"worse", "better", "slower", "faster"};
    return words[static_cast<std::size_t>(kind)];
}

// Prints a row for SwTlas and one for each way of the driver.
void print_rows(std::ostream& out, std::span<const Record> records) {
    const std::vector<Finding> findings = findings_of(records);
    const std::vector<Speed> speeds = speeds_of(records);
    const CaseResults own = results_of(records, "K");
    for (const std::string_view backend : {"sw", "hw", "hw-pipeline"}) {
        std::set<std::string> cases;
        for (const Record& record : records)
            if (record.was_run && record.backend == backend && is_users_kernel(record)) cases.insert(record.case_id);
        if (cases.empty()) continue;
        out << "| " << records.front().device.name << ", " << records.front().device.driver << " | "
            << answerer(backend) << " | " << cases.size() << " |";
        for (const Mistake mistake : all_mistakes) {
            const Finding* found = find(findings, backend, mistake);
            out << ' ' << (found ? text_of(*found) : "") << " |";
        }
        const Speed* speed = find(speeds, backend, "watertight");
        out << ' '
            << (backend == "sw" || own.run.empty()
                    ? ""
                    : ids_text(own.failed_by_driver) + "; " + ids_text(own.not_as_advised))
            << " | "
            << (speed ? with_interval(speed->ratio, speed->ratio_95) + (speed->is_disturbed ? " (disturbed)" : "") : "")
            << " |\n";
    }
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
    }
    out << "\n| driver | answers | cases |";
    for (const Mistake mistake : all_mistakes) out << ' ' << name_of(mistake) << " |";
    out << " own structures: requirements broken; recommendations broken | time over SwTlas |\n|---|---|---|";
    for (std::size_t i = 0; i < all_mistakes.size(); ++i) out << "---|";
    out << "---|---|\n";
    for (const NamedReport& report : reports) print_rows(out, report.records);
    out << '\n';
}

void print_comparison(std::ostream& out, const Comparison& comparison) {
    for (const Change& change : comparison.changes)
        out << "  " << word_of(change.kind) << ": " << change.what << ": " << change.how << '\n';
    for (const TimeRatio& time : comparison.times)
        out << "  times of " << std::left << std::setw(24) << time.backend + ' ' + time.level
            << with_interval(time.ratio, time.ratio_95, 3) << " over " << time.measurements << " measurements\n";
    out << "  all times together: " << number(comparison.drift, 3)
        << " times as long; the ratios above are relative to this\n  " << comparison.compared
        << " measurements compared, " << comparison.only_before << " only before, " << comparison.only_now
        << " only now; " << comparison.tests << " tests, which report a change where there is none in at most "
        << number(100 * false_alarms) << " % of comparisons\n  "
        << (comparison.has_one_seed
                ? ""
                : "the seeds differ, and so do the scenes: rates are compared over all cases together\n  ")
        << (comparison.is_worse()        ? "verdict: worse"
            : comparison.changes.empty() ? "verdict: no change beyond noise"
                                         : "verdict: changed, and nothing is worse")
        << '\n';
}

void print_other_lines(std::ostream& out, const JsonLines& baseline) {
    std::vector<std::string> parts;
    for (const auto& [kind, count] : baseline.others) parts.push_back(text(count, " of ", kind));
    if (!parts.empty()) out << "  not compared: " << joined(parts) << '\n';
}

}  // namespace twinray::report
