// SPDX-License-Identifier: MIT
// Cases of suites: --only and --list, which choose them, and `twinray verify --suite conformance`.
#pragma once

#include "cli/common.h"
#include "report/conformance/suite.h"
#include "report/frame/cases.h"

namespace twinray::cli {

// --only and --list: which cases of a suite run.
Option only_option(std::vector<std::string>& patterns);
Option list_option(bool& lists);

std::vector<frame::Case> cases_of_conformance();
// All cases of the report: the catalogue, one for each scene of the user's, and those of conformance.
std::vector<frame::Case> cases_of_report(std::span<const std::filesystem::path> scenes = {});

// UsageError, if a pattern fits none of them, which `where` has all of.
void check_choice(std::span<const std::string> patterns, std::span<const frame::Case> cases, const std::string& where);
// Prints those that are chosen, a line each: "W01  closed icosphere, ...".
void list_cases(std::span<const std::string> patterns, std::span<const frame::Case> cases);

struct SuiteOptions {
    std::string name;
    std::vector<std::string> only;  // of its cases
    bool is_full = false, lists = false;
};
Section suite_section(SuiteOptions& options);

// Runs the cases that were chosen, or lists them; prints a line a topic and what failed. Exit status: 1 where the suite
// itself is at fault, and under --strict where the driver fails what Vulkan demands.
int verify_suite(const CommonOptions& options, const SuiteOptions& suite);

// The same cases, for the commands that have them among others: each record goes to `recorder`, and to `on_record`.
// They run in a process of their own: where a driver ends it, that is a fault of the driver in the case that ran, and
// another process goes on with the next.
void run_conformance(const CommonOptions& options, const std::vector<std::string>& only, bool is_full,
                     Recorder& recorder, const std::function<void(const Record&)>& on_record = {});

}  // namespace twinray::cli
