// SPDX-License-Identifier: MIT
// A report as lines of text.
#pragma once

#include <ostream>

#include "validation/records/recorder.h"

namespace twinray::report {

// The verdict, each fault of twinray, then how many records came to what.
void print_summary(std::ostream& out, std::span<const Record> records);
// Lines of a baseline that are no records of a report.
void print_other_lines(std::ostream& out, const JsonLines& baseline);

}  // namespace twinray::report
