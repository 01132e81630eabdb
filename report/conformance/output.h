// SPDX-License-Identifier: MIT
// The results of a suite's run as text.
#pragma once

#include <ostream>

#include "report/conformance/suite.h"

namespace twinray::conformance {

// Prints a line for each topic, below it each case that failed or was not run, with its first example; then the sum.
void print(std::ostream& out, std::span<const Record> records);

}  // namespace twinray::conformance
