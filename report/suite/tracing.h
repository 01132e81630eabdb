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

// A negative control: SwTlas's own trace kernel, without something on which a promise rests. A case that counts 0
// faults says little until it has shown faults of these.
struct Control {
    TraceProgramCode code;  // its name becomes Record::variant
    // If false, the driver decides whether it shows faults, so that it is only measured.
    bool must_show = true;
    double least_rate = 0;              // of faults, which it must exceed
    std::optional<Layout> layout = {};  // the only one that shows anything
};

// To add one: a macro in shaders/shared that leaves the thing out, and a twinray_compile_shader() of
// shaders/engine/trace.comp with it in this folder's CMakeLists.txt.

// Compiles without `precise`: no operation is NoContraction. It leaks if the driver contracts or reassociates.
Control without_precise();
// Computes the result of a driver that contracts, on any driver with float64: edge functions with one rounding instead
// of two, so that two triangles may disagree about the edge between them.
Control contracted();
// Leaves boxes as they are: rounding tells planes apart that a ray reaches at the same t. Boxes of compressed4 are
// rounded outwards by more, so that only bvh2 shows what the padding is for.
Control without_padding();

// The scene that the rays of a case meet.
struct World {
    std::function<void(AbstractAccel&)> fill;  // into an empty accelerator
    ReferenceScene reference;                  // of the same scene
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
    // GPU time of the trace alone, one entry per repetition; wall time if the queue has no timestamps.
    std::vector<double> ns_per_ray;
    bool has_timestamps = true;
    std::map<std::string, double> phases_ms;  // build, compile (with the first trace), copy
};

// Returns one entry per configuration. The repetitions take turns, so that other load on the machine affects all
// configurations alike.
std::vector<Traced> trace(Devices& devices, std::span<const Configuration> configurations, const World& world,
                          const Tracing& tracing);

// Returns how often each ray crosses the world, see CaseRun::count_crossings().
std::vector<uint> crossings_of(Devices& devices, const Configuration& configuration, const World& world,
                               std::span<const Ray> rays);

TimeFigures time_figures(const Traced& traced);
// Takes any repetitions, at least one.
TimeFigures time_figures(const std::string& metric, std::vector<double> samples);
// Returns the GPU time of all passes.
double total_ms(const std::vector<PassTiming>& timings);

}  // namespace twinray::suite
