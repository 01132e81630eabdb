// SPDX-License-Identifier: MIT
// The choice of the suite's next case and its effort, by pure functions; and the finished cases, as a file.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::suite {

// A step of effort: a case goes from its least amount (0) to its full amount (1).
inline constexpr double effort_step = 0.25;

// The progress of a case that has run.
struct CaseProgress {
    double effort = 0;
    double seconds = 0;       // of the last run
    double growth = 4;        // of its seconds with a step of effort: a guess until it is measured
    double uncertainty = 0;   // uncertainty_of() its records
    bool can_improve = true;  // false if the last step left it as uncertain as it was
};

// Returns half the widest 95 % interval of a rate of faults among the records whose faults count, or 0 without any.
double uncertainty_of(std::span<const Record> records);

// Returns the case after one more step of effort, which took `seconds`.
CaseProgress after_step(const CaseProgress& before, double seconds, double uncertainty);

// Returns the least certain case that can improve and is likely to be done in time with one more step of effort.
std::optional<std::size_t> next_to_improve(std::span<const CaseProgress> cases, double seconds_left);

// Returns the order of a first round that reaches every section early: the first case of each, then the second, ...
// `sections` is the section of each case; the order is of their indices.
std::vector<std::size_t> by_turns(std::span<const char> sections);

// The finished cases of a run, so that an interrupted run can continue.
struct SuiteState {
    std::filesystem::path file = {};  // "" = kept in memory alone
    std::string key = {};             // all that must be the same for a run to go on: version, device, suite, seed, ...
    std::map<std::string, CaseProgress> cases = {};  // by id: the finished ones
    double seconds = 0;                              // how long they took
};

// Throws Error naming the file if it cannot be read or has another key.
SuiteState read_state(const std::filesystem::path& file, const std::string& key);
// Replaces the file at once. Throws Error naming it.
void write_state(const SuiteState& state);

}  // namespace twinray::suite
