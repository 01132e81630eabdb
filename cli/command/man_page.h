// SPDX-License-Identifier: MIT
// Man pages of section 1, in roff with the macros of man(7).
#pragma once

#include "cli/command/command.h"

namespace twinray::cli {

// twinray-COMMAND.1
std::string man_page(const Command& command, const std::string& version);
// twinray.1: all commands.
std::string man_page(std::span<const Command> commands, const std::string& version);

}  // namespace twinray::cli
