// SPDX-License-Identifier: MIT
// What --help prints.
#pragma once

#include "cli/command/command.h"

namespace twinray::cli {

// Words of a paragraph in lines of at most `width` letters, `indent` blanks before each. A longer word stands alone.
std::string wrapped(const std::string& paragraph, std::size_t width, std::size_t indent);

// Of one command, like a man page.
std::string help_text(const Command& command, std::size_t width);
// A line for each command, under the headings of their groups.
std::string list_text(std::span<const Command> commands, std::size_t width);

// Of the terminal that stdout is, else 80.
std::size_t terminal_width();

}  // namespace twinray::cli
