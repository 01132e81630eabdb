// SPDX-License-Identifier: MIT
// Parses arguments into values, by CLI11, and suggests what a misspelt word may have meant.
#pragma once

#include <string_view>

#include "cli/command/command.h"

namespace twinray::cli {

// Reads the arguments after the command's name into what its values are bound to. Returns false if they ask for --help.
// Throws UsageError that names the option, the value and what is allowed.
bool parse(const Command& command, const std::vector<std::string>& arguments);

// Returns how many letters must be inserted, removed, replaced or swapped with their neighbour to turn one into the
// other (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the first candidate that begins with the whole word, of two or more letters; else the nearest one, the first
// among equals; empty if none is near: at most a third of the word's letters may be wrong, and one always may.
std::string nearest_to(std::string_view word, std::span<const std::string> candidates);

}  // namespace twinray::cli
