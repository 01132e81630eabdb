// SPDX-License-Identifier: MIT
// A comparison as text and as records.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <ostream>
#include <vector>

#include "validation/verify/comparison.h"

namespace twinray {

void print(std::ostream& out, const RaySet& set, const Comparison& comparison, bool has_hardware);

// One an accelerator, added to the fields of `base`. `hardware` may be null.
std::vector<nlohmann::json> records_of(const nlohmann::json& base, const RaySet& set, const Comparison& comparison,
                                       const HwTlas* hardware);

}  // namespace twinray
