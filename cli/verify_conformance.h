// SPDX-License-Identifier: MIT
// `twinray verify --suite conformance`.
#pragma once

#include "cli/common.h"

namespace twinray::cli {

// Runs the cases that `only` names, all without it; prints a line a topic and what failed. Exit status: 1 where the
// suite itself is at fault, and under --strict where the driver fails what Vulkan demands.
int verify_conformance(const CommonOptions& options, const std::vector<std::string>& only, bool is_full);

}  // namespace twinray::cli
