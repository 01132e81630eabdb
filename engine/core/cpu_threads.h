// SPDX-License-Identifier: MIT
// The threads of a CPU driver.
#pragma once

namespace twinray {

// Returns the number of threads on which a CPU driver runs groups: LP_NUM_THREADS (of Mesa) if that is a number above
// 0, else one per core.
unsigned count_cpu_threads();

}  // namespace twinray
