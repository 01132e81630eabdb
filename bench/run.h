// SPDX-License-Identifier: MIT
// A scene, from its name to results.
#pragma once

#include <map>

#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rays.h"

namespace twinray::bench {

struct RunOptions {
    LineUpOptions line_up;
    std::vector<RayKind> kinds = {usual_ray_kinds.begin(), usual_ray_kinds.end()};
    uint width = 1024;  // pixels a side, a multiple of 8: each set has width * width rays
    std::size_t rounds = 5;
    bool times_builds = true;  // else each is built once, and no time is given
    double max_seconds = 1;    // see TraceSettings::max_ms
    std::uint64_t seed = 1;
    bool quiet = false;  // no progress bar
};

// Scenes with more triangles in their meshes are not checked: the reference would take longer than all measurements.
inline constexpr std::size_t most_checked_triangles = 3'000'000;

struct Measured {
    std::vector<BuildRounds> builds;                     // by backend
    std::map<RayKind, std::vector<TraceRounds>> traces;  // by backend
};

Measured measure(Context& context, LineUp& line_up, const BenchScene& scene, const RunOptions& options);

}  // namespace twinray::bench
