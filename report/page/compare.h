// Two reports beside each other: what changed beyond noise. Pure functions of their records.
#pragma once

#include <filesystem>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "validation/records/recorder.h"

namespace twinray::report {

// The chance that something is reported although nothing changed, over all tests of a comparison together.
inline constexpr double false_alarms = 0.05;
// Times of a group count as changed if their ratio is beyond this, or its inverse, beyond noise.
inline constexpr double tolerated_ratio = 1.1;

struct Change {
    enum class Kind : std::uint8_t { worse, better, slower, faster } kind;
    std::string what;  // "W04 hw watertight {aim vertex}", "times of sw refined"
    std::string how;   // "HW_LEAK 0 of 4,096 -> 46 of 4,096", "1.3 (1.2 to 1.4)"

    bool operator==(const Change&) const = default;
};

// Times of one accelerator and level over all cases, divided by the median of all ratios, which shows how busy the
// machine was.
struct TimeRatio {
    std::string backend, level;
    double ratio = 1;
    Interval ratio_95 = {1, 1};  // bootstrap, of whole cases
    std::size_t measurements = 0;
};

struct Comparison {
    std::vector<Change> changes;
    std::vector<TimeRatio> times;
    double drift = 1;                           // of all times together
    std::size_t compared = 0;                   // records with a counterpart
    std::size_t tests = 0;                      // of the hypothesis that nothing changed
    std::size_t only_before = 0, only_now = 0;  // without one
    bool has_one_seed = true;                   // both asked the same rays, if they asked as many

    bool is_worse() const;
};

// Records correspond if case, settings, accelerator, level and variant are the same. Fisher's exact test compares
// counts of classes and of faults, for each record, and for each accelerator and level over all cases with as many
// rays. If seeds differ, so do the scenes, and the rays of a case are no independent trials: then the sign test
// compares whole cases, over all cases only. The bootstrap compares times of as many rays. A test that Holm's procedure
// (1979) keeps at false_alarms is a change. Some changes are certain without a test: a new fault of twinray; a record
// of under 100 items that asked the same (seed and n) and no longer passes, or passes again; a record that ran and no
// longer does, or all of a case, accelerator and level.
Comparison compare(std::span<const Record> before, std::span<const Record> now);

// Tests of the hypothesis that nothing changed.

// Returns P of a table at least as unlikely as this one if both rates are the same: Fisher's exact test (1922),
// two-sided.
double fisher_exact(std::uint64_t count_a, std::uint64_t n_a, std::uint64_t count_b, std::uint64_t n_b);

// Returns which of the hypotheses with these p are refuted so that the chance to refute a true one is at most `level`.
std::vector<bool> holm(std::span<const double> p, double level);

// Returns P of this many ups among ups and downs, or more extreme, if both are equally likely: the sign test,
// two-sided.
double sign_test(std::size_t ups, std::size_t downs);

// Reports beside each other, as text.

struct NamedReport {
    std::string name;
    std::vector<Record> records;
};
// Reads a file of JSON lines, or a folder with report.jsonl in it. Throws Error naming what cannot be read or has no
// record.
NamedReport read_report(const std::filesystem::path& path);

// Prints device, driver and version of each, and a table in Markdown: how often each was wrong in which way, which
// cases of the driver's own structures it fails, and how its time compares with SwTlas's.
void print_side_by_side(std::ostream& out, std::span<const NamedReport> reports);
// Prints the changes, the ratios of times, and a verdict with its probability of a false alarm.
void print_comparison(std::ostream& out, const Comparison& comparison);

// Prints the lines of a baseline that are no records of a report.
void print_other_lines(std::ostream& out, const JsonLines& baseline);

}  // namespace twinray::report
