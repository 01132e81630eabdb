// SPDX-License-Identifier: MIT
// What a run is told as: text, and a line of JSON.
#pragma once

#include "samples/particles/options.h"

namespace twinray::particles {

struct RunTimes {
    double submit_ms = 0;                // until the host had submitted all frames
    double total_ms = 0;                 // until the GPU was done with them
    bool was_ahead = false;              // all frames were submitted before the GPU was done with the last
    std::vector<PassTiming> last_frame;  // of the GPU
};

// Prints unless quiet, and appends to the file of --json. Throws Error naming it.
void report(const Options& options, const AccelChoice& accel, const RunTimes& times);

}  // namespace twinray::particles
