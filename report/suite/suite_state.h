// SPDX-License-Identifier: MIT
// Which cases of a run are done, as a file, so that a run that was cut short goes on where it was.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "report/suite/schedule.h"

namespace twinray::suite {

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
