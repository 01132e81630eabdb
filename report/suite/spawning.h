// SPDX-License-Identifier: MIT
// Points of surfaces and rays that leave them, for cases F01 to F05, I10 and I15.
#pragma once

#include "engine/core/kernel.h"
#include "report/suite/case_run.h"
#include "twinray/glsl/cpp_spawn.h"

namespace twinray::suite {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/suite/spawn_args.h"
#include "twinray/glsl/cpp_end.h"

struct SpawnedRays {
    std::vector<Ray> rays;           // of every method, one per item
    std::vector<SpawnPrice> prices;  // of the items by SPAWN_BOUND
};

// A kernel that lets rays leave points of a mesh, by the function that users call. It is compiled once, and the rays
// are the same for all accelerators, because it traces nothing.
class Spawner {
  public:
    explicit Spawner(Context& context);
    SpawnedRays operator()(const Mesh& mesh, const Transform& instance, std::span<const SpawnItem> items) const;

  private:
    Context& context_;
    Kernel<SpawnArgs> kernel_;
};

// The outcome of a ray that left a surface.
enum class SpawnOutcome : std::uint8_t {
    right,
    false_hit,  // of its own triangle, or of nothing that lies there
    leak,       // past what it had to meet
    flagged,    // a leak past what lies within twice the point's offset, as the offset says
};

struct Departures {
    Mesh mesh = {};
    Transform transform = {};
    std::vector<SpawnItem> items = {};  // of instance 0
    Values params = {};
    std::function<SpawnOutcome(std::size_t item, const Hit& hit, const SpawnPrice& price)> outcome_of = {};
    // Negative control: without an offset, software must show faults; otherwise the case sees nothing.
    bool must_show = true;
    std::string fault_of = "twinray";  // "" = by the backend
};

// Spawns every item by every method, traces the closest hits on each backend and records the outcomes. The public
// function must have no faults; those of the other methods are results.
void measure_departures(CaseRun& run, const Spawner& spawner, const Departures& departures);

// Return the linear part of a transform and, for normals, its inverse transposed, in float64.
glm::dmat3 linear_of(const Transform& transform);
glm::dmat3 normals_of(const Transform& transform);

}  // namespace twinray::suite
