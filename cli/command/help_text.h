// SPDX-License-Identifier: MIT
// What commands say of themselves: --help, man pages, and scripts that let shells complete their words.
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

// Man pages of section 1, in roff with the macros of man(7): twinray-COMMAND.1, and twinray.1 of all commands.
std::string man_page(const Command& command, const std::string& version);
std::string man_page(std::span<const Command> commands, const std::string& version);

std::string bash_completion(std::span<const Command> commands);
std::string zsh_completion(std::span<const Command> commands);
std::string fish_completion(std::span<const Command> commands);

}  // namespace twinray::cli
