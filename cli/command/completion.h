// SPDX-License-Identifier: MIT
// Scripts that let shells complete the command's words.
#pragma once

#include "cli/command/command.h"

namespace twinray::cli {

std::string bash_completion(std::span<const Command> commands);
std::string zsh_completion(std::span<const Command> commands);
std::string fish_completion(std::span<const Command> commands);

}  // namespace twinray::cli
