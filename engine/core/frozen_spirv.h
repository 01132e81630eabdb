// SPDX-License-Identifier: MIT
// SPIR-V without specialisation constants.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <twinray/commands.h>

namespace twinray {

// Returns the module with these values, and its own defaults, in place of its specialisation constants and of
// expressions that depend only on them.
std::vector<std::uint32_t> freeze_constants(std::span<const std::uint32_t> spirv,
                                            std::span<const SpecializationConstant> constants);

}  // namespace twinray
