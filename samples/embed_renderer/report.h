// SPDX-License-Identifier: MIT
// What the frames cost: medians over the frames, by pass.
#pragma once

#include "samples/embed_renderer/renderer.h"

namespace twinray::embed_renderer {

struct Costs {
    struct Pass {
        std::string name;
        double ms = 0;  // median
        bool is_twinrays = false;
    };
    std::vector<Pass> passes;  // in the order of the frame
    double frame_ms = 0;       // of all passes
    double twinray_ms = 0;     // of those that are twinray's
    double twinray_percent() const { return frame_ms > 0 ? 100 * twinray_ms / frame_ms : 0; }
};

// The first frame counts only where it is the only one: there the first move rebuilds.
Costs costs_of(const std::vector<std::vector<PassTimer::Lap>>& frames);

void report(const Options& options, const AccelChoice& accel, const Costs& costs, const RayCounts& rays);

}  // namespace twinray::embed_renderer
