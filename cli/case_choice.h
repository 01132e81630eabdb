// SPDX-License-Identifier: MIT
// --only and --list: which cases of a suite run.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cli/command/command.h"
#include "report/frame/cases.h"

namespace twinray::cli {

Option only_option(std::vector<std::string>& patterns);
Option list_option(bool& lists);

std::vector<frame::Case> cases_of_conformance();
// All cases of the report: the catalogue, one for each scene of the user's, and those of conformance.
std::vector<frame::Case> cases_of_report(std::span<const std::filesystem::path> scenes = {});

// UsageError, if a pattern fits none of them, which `where` has all of.
void check_choice(std::span<const std::string> patterns, std::span<const frame::Case> cases, const std::string& where);
// Prints those that are chosen, a line each: "W01  closed icosphere, ...".
void list_cases(std::span<const std::string> patterns, std::span<const frame::Case> cases);

}  // namespace twinray::cli
