// SPDX-License-Identifier: MIT
// The threads of a driver for CPUs.
#pragma once

namespace twinray {

// On how many threads a driver for CPUs runs groups: LP_NUM_THREADS (of Mesa) where that is a number above 0, else one
// a core.
unsigned count_cpu_threads();

}  // namespace twinray
