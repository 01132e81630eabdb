// SPDX-License-Identifier: MIT
// The texts that describe commands: --help, man pages, and scripts that let shells complete words.
#pragma once

#include "cli/command/command.h"

namespace twinray::cli {

// Breaks a paragraph into lines of at most `width` letters, each after `indent` blanks. A longer word has its own line.
std::string wrapped(const std::string& paragraph, std::size_t width, std::size_t indent);

// Returns the help of one command, in the style of a man page.
std::string help_text(const Command& command, std::size_t width);
// Returns a line for each command, under the headings of their groups.
std::string list_text(std::span<const Command> commands, std::size_t width);

// Returns the width of the terminal that stdout is, else 80.
std::size_t terminal_width();

// Returns a man page of section 1, in roff with the macros of man(7): twinray-COMMAND.1, or twinray.1 of all commands.
std::string man_page(const Command& command, const std::string& version);
std::string man_page(std::span<const Command> commands, const std::string& version);

std::string bash_completion(std::span<const Command> commands);
std::string zsh_completion(std::span<const Command> commands);
std::string fish_completion(std::span<const Command> commands);

}  // namespace twinray::cli
