// SPDX-License-Identifier: MIT
// Arguments into values, by CLI11, and what someone who wrote a word wrongly may have meant.
#pragma once

#include <string_view>

#include "cli/command/command.h"

namespace twinray::cli {

// Takes the arguments after the command's name into what its values are bound to. Returns false where they ask for
// --help. Throws UsageError that names the option, the value and what is allowed.
bool parse(const Command& command, const std::vector<std::string>& arguments);

// How many letters must be inserted, removed, replaced or swapped with their neighbour to make one of the other
// (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

// The first of the candidates that begins with two or more letters that were all of the word; else the nearest of them,
// the first of those as near; empty where none is near: at most a third of the word's letters may be wrong, and one
// always may.
std::string nearest_to(std::string_view word, std::span<const std::string> candidates);

}  // namespace twinray::cli
