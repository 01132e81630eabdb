// Cases of suites: --only and --list, which choose them, and `twinray verify --suite conformance`.
#pragma once

#include "cli/common.h"
#include "report/conformance/suite.h"
#include "report/frame/cases.h"

namespace twinray::cli {

// These return --only and --list, which choose the cases of a suite.
Option only_option(std::vector<std::string>& patterns);
Option list_option(bool& lists);

std::vector<frame::Case> cases_of_conformance();
// Returns all cases of the report: the catalogue, one for each of the user's scenes, and those of conformance.
std::vector<frame::Case> cases_of_report(std::span<const std::filesystem::path> scenes = {});

// Throws UsageError if a pattern fits none of the cases. `where`: the command that lists them.
void check_choice(std::span<const std::string> patterns, std::span<const frame::Case> cases, const std::string& where);
// Prints the chosen cases, a line each: "W01  closed icosphere, ...".
void list_cases(std::span<const std::string> patterns, std::span<const frame::Case> cases);

struct SuiteOptions {
    std::string name;
    std::vector<std::string> only;  // of its cases
    bool is_full = false, lists = false;
};
Section suite_section(SuiteOptions& options);

// Runs the chosen cases, or lists them; prints a line for each topic and what failed. Returns exit status 1 if the
// suite itself is at fault, and under --strict if the driver fails what Vulkan demands.
int verify_suite(const CommonOptions& options, const SuiteOptions& suite);

// Runs the same cases for commands that have others as well: each record goes to `recorder` and to `on_record`. They
// run in a process of their own: if a driver ends it, that is a fault of the driver in the case that ran, and another
// process goes on with the next.
void run_conformance(const CommonOptions& options, const std::vector<std::string>& only, bool is_full,
                     Recorder& recorder, const std::function<void(const Record&)>& on_record = {});

}  // namespace twinray::cli
