// SPDX-License-Identifier: MIT
// Which case of the suite to run next, and how thoroughly, by pure functions; which are done, as a file.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::suite {

// How much of a case is done, from its least (0) to its full amount (1).
inline constexpr double effort_step = 0.25;

// The knowledge about a case that has run.
struct CaseProgress {
    double effort = 0;
    double seconds = 0;       // the last run
    double growth = 4;        // of its seconds with a step of effort: a guess until it was seen
    double uncertainty = 0;   // uncertainty_of() its records
    bool can_improve = true;  // false where the last step left it as uncertain as it was
};

// Half the widest 95 % interval of a rate of faults among the records whose faults count. 0 where there is none.
double uncertainty_of(std::span<const Record> records);

// The case after one more step of effort, which took `seconds`.
CaseProgress after_step(const CaseProgress& before, double seconds, double uncertainty);

// The least certain case, of those that can improve, that is likely to be done in time with one more step of effort.
std::optional<std::size_t> next_to_improve(std::span<const CaseProgress> cases, double seconds_left);

// The order of a first round that reaches every section early: the first case of each, then the second, ... `sections`
// is the section of each case; returns their indices.
std::vector<std::size_t> by_turns(std::span<const char> sections);

// Which cases of a run are done, so that a run that was cut short goes on where it was.
struct SuiteState {
    std::filesystem::path file = {};  // "" = kept in memory alone
    std::string key = {};             // all that must be the same for a run to go on: version, device, suite, seed, ...
    std::map<std::string, CaseProgress> cases = {};  // by id: those that are done
    double seconds = 0;                              // that they took
};

// Throws Error naming the file where it cannot be read, or where its key is another.
SuiteState read_state(const std::filesystem::path& file, const std::string& key);
// Replaces the file at once. Throws Error naming it.
void write_state(const SuiteState& state);

}  // namespace twinray::suite
