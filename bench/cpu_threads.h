// SPDX-License-Identifier: MIT
#pragma once

namespace twinray::bench {

// How many threads a CPU contestant takes, so that it has as many as lavapipe: LP_NUM_THREADS where that is a number
// above 0, else one a core.
unsigned count_cpu_threads();

}  // namespace twinray::bench
