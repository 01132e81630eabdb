// SPDX-License-Identifier: MIT
#include "cli/case_choice.h"

#include <algorithm>

#include "cli/command/values.h"
#include "engine/core/error.h"
#include "validation/suite/suite.h"

namespace twinray::cli {

Option only_option(std::vector<std::string>& patterns) {
    return {.name = "--only", .value = words(patterns, "CASE,..."), .help = "case ids with * and ?, as N07,B*"};
}

bool is_chosen(std::span<const std::string> patterns, const std::string& id) {
    return patterns.empty() ||
           std::ranges::any_of(patterns, [&](const std::string& pattern) { return suite::matches(id, pattern); });
}

void check_choice(std::span<const std::string> patterns, std::span<const std::string> ids, const std::string& where) {
    for (const std::string& pattern : patterns)
        if (std::ranges::none_of(ids, [&](const std::string& id) { return suite::matches(id, pattern); }))
            throw UsageError(text("--only ", pattern, " fits no case; all are in ", where));
}

}  // namespace twinray::cli
