// SPDX-License-Identifier: MIT
// What a report says first: what is right, what is wrong, how fast, against which reference. Pure functions of its
// records.
#pragma once

#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::report {

// "pass", "fault of twinray", "fault of driver", "measured" or "not run".
std::string result_of(const Record& record);
// Whether Vulkan only advises what the record's case asks: who fails it is not at fault.
bool is_only_advised(const Record& record);
// Records that show a fault of ours: where there is one the command exits with 1.
std::size_t faults_of_ours(std::span<const Record> records);

// A way to be wrong, over all cases that can show it.
enum class Mistake : std::uint8_t { leak, false_hit, wrong_distance, not_finite, counted_wrong };
inline constexpr std::array all_mistakes = {Mistake::leak, Mistake::false_hit, Mistake::wrong_distance,
                                            Mistake::not_finite, Mistake::counted_wrong};
std::string_view name_of(Mistake mistake);  // "rays lost at edges and vertices"

// How often who answers makes a mistake, at levels that promise not to.
struct Finding {
    std::string backend;
    Mistake mistake = Mistake::leak;
    std::uint64_t faults = 0, n = 0;  // of the rays that were checked for it
    std::string worst_case = {};      // the case with the highest rate: "" where there is none
    std::uint64_t worst_faults = 0, worst_n = 0;
};
// One for each mistake that a backend among the records was checked for. Leaks are counted over rays that are aimed at
// edges and vertices (section W), the others over all.
std::vector<Finding> findings_of(std::span<const Record> records);

// The time of a trace over SwTlas's at watertight, of the same rays, 2048 or more: the geometric mean over the
// measurements of both, with a 95 % interval by bootstrap over them.
struct Speed {
    std::string backend, level;
    double ratio = 1;
    Interval ratio_95 = {1, 1};
    std::size_t measurements = 0;
    double median_p99_ulp = 0, worst_p99_ulp = 0;  // of t, over the cases that measured an error; 0: none did
};
std::vector<Speed> speeds_of(std::span<const Record> records);

// Cases about the driver's own structures (K), over both ways to trace: those that ran, those that fail what Vulkan
// demands, or advises.
struct OwnStructures {
    std::set<std::string> all, musts, shoulds;
};
OwnStructures own_structures_of(std::span<const Record> records);

struct Sentence {
    enum class Kind : std::uint8_t { right, wrong, measured } kind;
    std::string about, text;  // "Speed", "the driver's ray queries take ..."
};

struct Verdict {
    bool is_driver_right = true, are_we_right = true, has_driver = false;
    std::string headline;
    std::vector<Sentence> sentences;
};
Verdict verdict_of(std::span<const Record> records);

}  // namespace twinray::report
