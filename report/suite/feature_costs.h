// SPDX-License-Identifier: MIT
// What features of SwTlas's kernel cost a scene that does not need them.
#pragma once

#include "report/suite/case_run.h"

namespace twinray::suite {

// A record for each feature that is added, of closest and of any hits: the time over that of the kernel with what is
// needed alone (of_needed, the median over rounds in which all take turns, with its 95 % interval of_needed_low and
// of_needed_high). A fault is a ray that finds another hit.
void feature_costs(CaseRun& run);

}  // namespace twinray::suite
