// SPDX-License-Identifier: MIT
// SPIR-V without branches that constants decide.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace twinray {

// Returns the module without the blocks that no invocation can reach, by conditions that are constants, and without
// functions that are then not called. A module with debug information that names code is returned unchanged.
std::vector<std::uint32_t> prune_branches(std::span<const std::uint32_t> spirv);

}  // namespace twinray
