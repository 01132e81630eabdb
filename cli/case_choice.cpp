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
    return {.name = "--only",
            .value = words(patterns, "CASE,..."),
            .help = "case ids, with * and ? as wildcards, such as N07,B*"};
}

Option list_option(bool& lists) {
    return {.name = "--list",
            .value = flag(lists),
            .help = "list the cases, or those that --only selects, and run nothing"};
}

std::vector<frame::Case> cases_of_conformance() {
    std::vector<frame::Case> cases;
    for (const conformance::Case& row : conformance::catalogue())
        cases.emplace_back(row).criterion += text(" (", name_of(row.demand), ')');
    return cases;
}

std::vector<frame::Case> cases_of_report(std::span<const std::filesystem::path> scenes) {
    std::vector<frame::Case> cases;
    for (const auto& part : {suite::catalogue(), suite::scene_cases(scenes)})
        cases.insert(cases.end(), part.begin(), part.end());
    for (frame::Case& row : cases_of_conformance()) cases.push_back(std::move(row));
    return cases;
}

void check_choice(std::span<const std::string> patterns, std::span<const frame::Case> cases, const std::string& where) {
    for (const std::string& pattern : patterns)
        if (std::ranges::none_of(cases, [&](const frame::Case& row) { return frame::matches(row.id, pattern); }))
            throw UsageError(text("--only ", pattern, " matches no case; see ", where));
}

void list_cases(std::span<const std::string> patterns, std::span<const frame::Case> cases) {
    for (const frame::Case& row : cases)
        if (frame::is_chosen(patterns, row.id)) std::cout << row.id << "  " << row.title << '\n';
}

}  // namespace twinray::cli
