// SPDX-License-Identifier: MIT
// Arguments into values, by CLI11.
#pragma once

#include "cli/command/command.h"

namespace twinray::cli {

// Takes the arguments after the command's name into what its values are bound to. Returns false where they ask for
// --help. Throws UsageError that names the option, the value and what is allowed.
bool parse(const Command& command, const std::vector<std::string>& arguments);

}  // namespace twinray::cli
