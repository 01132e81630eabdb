// SPDX-License-Identifier: MIT
// What contours and areas tell of a scene, for ViewFactors to put in place of hits.
#pragma once

#include "engine/analysis/pair_plan.h"
#include "engine/analysis/view_factors.h"

namespace twinray {

struct PairExchanges {
    std::vector<KnownExchange> known;  // ascending by i, then j
    std::uint64_t left_to_hits = 0;    // pairs of groups that may see each other
    std::uint64_t rays = 0;            // between points of faces
};

// The pairs of areas share as many rays as a row has, but get at least 64 for two faces, and more where their intervals
// would be wider than those of hits; with options.target_error, their
// rays are doubled until the interval of both view factors is short enough. The same exchanges come of the same scene
// and options, on any number of threads. `faces` are those of `scene`, which push_scene() put into `accel`. Throws
// Error as plan_pairs() does. `progress` is told of groups.
PairExchanges exchanges_of_pairs(AbstractAccel& accel, const Scene& scene, const Faces& faces,
                                 const ViewFactorOptions& options, PairEstimator estimator,
                                 Progress* progress = nullptr);

}  // namespace twinray
