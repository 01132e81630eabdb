// SPDX-License-Identifier: MIT
// What each case found, folded: a part of the page of a report.
#pragma once

#include <ostream>

#include "report/page/page.h"

namespace twinray::report {

// A row for each accelerator, level and variant of a case, over all its settings: the file of records has these apart.
void write_case_tables(std::ostream& out, const PageInput& input);
// Grouped by reason.
void write_not_run(std::ostream& out, const PageInput& input);

}  // namespace twinray::report
