// SPDX-License-Identifier: MIT
// --only: which cases of a suite run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/command/command.h"

namespace twinray::cli {

Option only_option(std::vector<std::string>& patterns);

// Whether a pattern fits the id; without patterns all are chosen.
bool is_chosen(std::span<const std::string> patterns, const std::string& id);

// UsageError, if a pattern fits none of the ids, which `where` has all of.
void check_choice(std::span<const std::string> patterns, std::span<const std::string> ids, const std::string& where);

}  // namespace twinray::cli
