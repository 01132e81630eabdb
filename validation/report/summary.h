// SPDX-License-Identifier: MIT
// A report as lines of text.
#pragma once

#include <ostream>

#include "validation/records/recorder.h"
#include "validation/report/baseline.h"

namespace twinray::report {

// What did not pass, then how many records came to what.
void print_summary(std::ostream& out, std::span<const Record> records);
// What there was to compare with.
void print_baseline(std::ostream& out, const JsonLines& baseline, std::span<const Record> records);
void print_changes(std::ostream& out, std::span<const Change> changes);

}  // namespace twinray::report
