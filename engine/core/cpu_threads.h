// SPDX-License-Identifier: MIT
#pragma once

namespace twinray {

// How many threads lavapipe runs groups on: LP_NUM_THREADS where that is a number above 0, else one a core.
unsigned count_cpu_threads();

}  // namespace twinray
