// SPDX-License-Identifier: MIT
// Tracing the same rays on several configurations, timed side by side, and by negative controls.
#pragma once

#include <map>
#include <optional>

#include "engine/accel/trace_desc.h"
#include "engine/accel/trace_program.h"
#include "engine/core/stopwatch.h"
#include "report/suite/suite.h"
#include "validation/reference/reference_scene.h"

namespace twinray::suite {

// A negative control: SwTlas's own trace kernel, without something that a promise rests on. A case that counts 0 faults
// says little until it has shown faults of these.
struct Control {
    TraceProgramCode code;  // its name becomes Record::variant
    // False: whether it shows faults is up to the driver, so that it is only measured.
    bool must_show = true;
    double least_rate = 0;              // of faults, which it must exceed
    std::optional<Layout> layout = {};  // the only one that shows anything
};

// To add one: a macro in shaders/shared that leaves the thing out, and a twinray_compile_shader() of
// shaders/engine/trace.comp with it in this folder's CMakeLists.txt.

// Without `precise`: no operation is NoContraction. Leaks where the driver contracts or reassociates.
Control without_precise();
// The result of a driver that contracts, computed on any driver with float64: edge functions with one rounding instead
// of two, so that two triangles may disagree about the edge between them.
Control contracted();
// Boxes as they are: planes that a ray reaches at the same t are told apart by rounding. Those of compressed4 are
// rounded outwards by more, so that it takes bvh2 to see what the padding is for.
Control without_padding();

// The scene that the rays of a case meet.
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
// GPU time of all passes.
double total_ms(const std::vector<PassTiming>& timings);

}  // namespace twinray::suite
