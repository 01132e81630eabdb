// SPDX-License-Identifier: MIT
// Tracing the same rays on several configurations, timed side by side.
#pragma once

#include <chrono>
#include <map>

#include "report/suite/controls.h"
#include "report/suite/devices.h"
#include "validation/reference/reference_scene.h"

namespace twinray::suite {

// What the rays of a case meet.
struct World {
    std::function<void(AbstractAccel&)> fill;  // into an empty accelerator
    ReferenceScene reference;                  // of the same
};
World world_of(const Scene& scene);
World world_of(const Mesh& mesh, const Transform& transform = {}, const InstanceOptions& options = {});

struct Tracing {
    std::span<const Ray> rays;
    std::size_t reps = 1;  // timed, after one that is not
    Query query = Query::closest;
    const Control* control = nullptr;  // in place of the kernel that users get; for SwTlas at watertight
};

struct Traced {
    Configuration configuration;
    std::vector<Hit> hits;
    // GPU time of the trace alone, one entry a repetition; wall time where the queue has no timestamps.
    std::vector<double> ns_per_ray;
    bool has_timestamps = true;
    std::map<std::string, double> phases_ms;  // build, compile (with the first trace), copy
};

// One entry a configuration. The repetitions take turns, so that whatever else the machine does meets all
// configurations alike.
std::vector<Traced> trace(Devices& devices, std::span<const Configuration> configurations, const World& world,
                          const Tracing& tracing);

TimeFigures time_figures(const Traced& traced);
// Of any repetitions, at least one.
TimeFigures time_figures(const std::string& metric, std::vector<double> samples);
using Clock = std::chrono::steady_clock;
double ms_since(Clock::time_point start);
// GPU time of all passes.
double total_ms(const std::vector<PassTiming>& timings);

}  // namespace twinray::suite
