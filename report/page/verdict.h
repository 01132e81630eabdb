// SPDX-License-Identifier: MIT
// The sentences with which a report begins: they say what is right, wrong or not measured, how fast, against which
// reference. Pure functions of its records. A sentence rests on the cases that report/suite/claims.h names.
#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "report/page/findings.h"

namespace twinray::report {

// "pass", "fault of twinray", "fault of driver", "measured" or "not run".
std::string result_of(const Record& record);
// Whether Vulkan only advises what the record's case asks: who fails it is not at fault.
bool is_only_advised(const Record& record);
// Records that show a fault of ours: where there is one the command exits with 1.
std::size_t faults_of_ours(std::span<const Record> records);

// The time of a trace over SwTlas's at watertight, of the same rays, 2048 or more: the geometric mean over the
// measurements of both, with a 95 % interval by bootstrap over them.
struct Speed {
    std::string backend, level;
    double ratio = 1;
    Interval ratio_95 = {1, 1};
    std::size_t measurements = 0;
    double median_p99_ulp = 0, worst_p99_ulp = 0;  // of t, over the cases that measured an error; 0: none did
    bool is_disturbed = false;                     // TimeFigures::is_disturbed() of any
};
std::vector<Speed> speeds_of(std::span<const Record> records);

// Cases by how they came out, over all who answer; those that Vulkan only advises apart.
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

}  // namespace twinray::report
