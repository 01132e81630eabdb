// SPDX-License-Identifier: MIT
// A run of the suite as text.
#pragma once

#include <ostream>

#include "report/conformance/suite.h"

namespace twinray::conformance {

// A line for each topic, below it each case that failed or was not run, with its first example; then the sum.
void print(std::ostream& out, std::span<const Record> records);

}  // namespace twinray::conformance
