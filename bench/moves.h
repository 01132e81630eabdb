// SPDX-License-Identifier: MIT
// What instances that a kernel moves cost.
#pragma once

#include <twinray/abstract_accel.h>

namespace twinray::bench {

// Medians of the GPU's times.
struct MoveTimes {
    double refit_ms = 0, rebuild_ms = 0;
};

// Of `count` instances of a sphere in an empty accelerator, whose transforms come from device memory.
MoveTimes measure_moves(AbstractAccel& accel, std::size_t count, std::size_t rounds);

}  // namespace twinray::bench
