// The sentences with which a report begins: they say what is right, wrong or not measured, how fast, and by which
// reference. Pure functions of its records. A sentence rests on the cases that report/suite/suite.cpp names.
#pragma once

#include <array>
#include <ostream>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::report {

// How often each accelerator makes each mistake: findings.cpp.

// A way to be wrong, over all cases that can show it.
enum class Mistake : std::uint8_t { leak, false_hit, wrong_distance, not_finite, counted_wrong };
inline constexpr std::array all_mistakes = {Mistake::leak, Mistake::false_hit, Mistake::wrong_distance,
                                            Mistake::not_finite, Mistake::counted_wrong};
std::string_view name_of(Mistake mistake);   // "rays lost at edges and vertices"
std::string_view wrong_of(Mistake mistake);  // what its maker does: "loses rays at edges and vertices"

// Rays of one case and kind.
struct RayKind {
    std::string case_id, settings;  // "W04", "aim vertex, cells 64"
    std::uint64_t faults = 0, n = 0;
};

// How often an accelerator makes a mistake. Each ray counts once: levels trace the same rays, so the finding is that of
// one level, the one with the most faults among those that promise none (the first of equals).
struct Finding {
    std::string backend, level;
    Mistake mistake = Mistake::leak;
    std::vector<RayKind> kinds = {};       // of the cases that it rests on
    std::vector<RayKind> elsewhere = {};   // of other cases, only those with faults
    std::size_t cases_run = 0, cases = 0;  // of those that it rests on

    bool is_complete() const { return cases_run == cases; }
    bool has_faults() const;
    std::uint64_t n() const;  // rays of `kinds`
    // Return one rate over all cases, and its 95 % interval. Each case counts as one, and so do its kinds of rays,
    // however thoroughly each was asked.
    double rate() const;
    Interval rate_95() const;
};
// Returns the finding of one level, which may be "fast".
Finding finding_at(std::span<const Record> records, std::string_view backend, std::string_view level, Mistake mistake);
// Returns one for each mistake that a backend among the records was checked for.
std::vector<Finding> findings_of(std::span<const Record> records);
// Returns the finding of a backend, or null if there is none.
const Finding* find(std::span<const Finding> findings, std::string_view backend, Mistake mistake);
// Returns "0.27 % (0.25 to 0.3) over 17 cases; most in W04, 4.6 % (4.2 to 5)", "0 of 230,000 rays, 17 cases (below
// ...)".
std::string text_of(const Finding& finding);

// The findings as sentences: verdict.cpp.

// Returns "pass", "fault of twinray", "fault of driver", "measured" or "not run".
std::string result_of(const Record& record);
// Returns whether Vulkan only advises what the record's case asks; failing it is then no fault.
bool is_only_advised(const Record& record);
// Returns how many records show a fault of twinray: with one, the command exits with 1.
std::size_t faults_of_ours(std::span<const Record> records);

// The time of a trace relative to SwTlas's at watertight, of the same rays, 2048 or more: the geometric mean over the
// measurements of both, with a 95 % interval by bootstrap over them.
struct Speed {
    std::string backend, level;
    double ratio = 1;
    Interval ratio_95 = {1, 1};
    std::size_t measurements = 0;
    double median_p99_ulp = 0;  // of t, over the cases that measured an error; 0: none did
    bool is_disturbed = false;  // TimeFigures::is_disturbed() of any
};
std::vector<Speed> speeds_of(std::span<const Record> records);
const Speed* find(std::span<const Speed> speeds, std::string_view backend, std::string_view level);  // null: none

// Cases by their results, over all accelerators; those that Vulkan only advises are apart.
struct CaseResults {
    std::set<std::string> run;  // of the catalogue
    std::set<std::string> failed_by_us, failed_by_driver, not_as_advised;
};
// `sections`: their letters, as "VRGCDP".
CaseResults results_of(std::span<const Record> records, std::string_view sections);

struct Sentence {
    enum class Kind : std::uint8_t { right, wrong, measured, not_measured } kind;
    std::string about, text;  // "Speed", "the driver's ray queries take ..."
};
std::string_view word_of(Sentence::Kind kind);  // "right", "wrong", "measured", "not measured"

struct Verdict {
    bool is_driver_right = true, are_we_right = true, has_driver = false;
    std::size_t cases_run = 0, cases = 0;  // of the catalogue
    std::string headline;
    std::vector<Sentence> sentences;
};
Verdict verdict_of(std::span<const Record> records);

// Prints a report as lines of text: the verdict, each fault of twinray, then how many records had which result.
void print_summary(std::ostream& out, std::span<const Record> records);

}  // namespace twinray::report
