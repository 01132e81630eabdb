// SPDX-License-Identifier: MIT
#include "cli/case_choice.h"

#include <algorithm>
#include <iostream>

#include "cli/command/values.h"
#include "engine/core/error.h"
#include "report/conformance/suite.h"
#include "report/suite/suite.h"

namespace twinray::cli {

Option only_option(std::vector<std::string>& patterns) {
    return {.name = "--only", .value = words(patterns, "CASE,..."), .help = "case ids with * and ?, as N07,B*"};
}

Option list_option(bool& lists) {
    return {.name = "--list", .value = flag(lists), .help = "run nothing: list the cases, or those of --only"};
}

std::vector<NamedCase> cases_of_conformance() {
    std::vector<NamedCase> cases;
    for (const conformance::Case& row : conformance::catalogue()) cases.push_back({row.id, row.what});
    return cases;
}

std::vector<NamedCase> cases_of_report(std::span<const std::filesystem::path> scenes) {
    std::vector<NamedCase> cases;
    for (const suite::SuiteCase& row : suite::catalogue()) cases.push_back({row.id, row.title});
    for (const suite::SuiteCase& row : suite::scene_cases(scenes)) cases.push_back({row.id, row.title});
    for (NamedCase& row : cases_of_conformance()) cases.push_back(std::move(row));
    return cases;
}

bool is_chosen(std::span<const std::string> patterns, const std::string& id) {
    return patterns.empty() ||
           std::ranges::any_of(patterns, [&](const std::string& pattern) { return suite::matches(id, pattern); });
}

void check_choice(std::span<const std::string> patterns, std::span<const NamedCase> cases, const std::string& where) {
    for (const std::string& pattern : patterns)
        if (std::ranges::none_of(cases, [&](const NamedCase& row) { return suite::matches(row.id, pattern); }))
            throw UsageError(text("--only ", pattern, " fits no case; all are in ", where));
}

void list_cases(std::span<const std::string> patterns, std::span<const NamedCase> cases) {
    for (const NamedCase& row : cases)
        if (is_chosen(patterns, row.id)) std::cout << row.id << "  " << row.title << '\n';
}

}  // namespace twinray::cli
