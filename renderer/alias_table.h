// SPDX-License-Identifier: MIT
// Sampling from discrete distributions in constant time (Walker 1977).
#pragma once

#include <span>
#include <vector>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// Columns that choose i with probability weights[i] / their sum. Weights are finite and >= 0; an empty table for none
// or for all 0. Vose, "A linear algorithm for generating random numbers with a given distribution", 1991.
std::vector<AliasEntry> make_alias_table(std::span<const double> weights);

}  // namespace twinray::path_tracer
