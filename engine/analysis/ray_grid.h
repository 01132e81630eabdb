// Parallel rays onto a scene, and their hits in batches on the device.
#pragma once

#include "engine/analysis/faces.h"
#include "engine/core/commands.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/ray_grid.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(RayGrid) == 64);

struct RayGridPlan {
    RayGrid grid;
    std::uint64_t ray_count = 0;  // 0 for a scene without finite triangles
    double cell_area = 0;         // across the rays
    dvec3 center = dvec3(0);      // of the grid
};

// Plans cells of a rectangle across the direction in front of all finite triangles, which covers their projection, with
// a margin of some roundings of their coordinates. Throws Error for a direction that is 0 or not finite, for `side`,
// and for scenes that float32 rays cannot start in front of.
RayGridPlan plan_ray_grid(const PlacedMeshes& placed, const RayGridDesc& desc);

// The most rays in a submission for a grid or for faces: 64 MiB on the device with their hits.
constexpr uint rays_of_batch = 1 << 20;

// A run of rays of a plan. It begins with an even number.
struct RayBatch {
    uint first = 0, count = 0;
};
// Each batch has at most rays_of_batch.
std::vector<RayBatch> ray_batches(std::uint64_t ray_count);

// Scales to length 1; throws Error for a direction that is 0 or not finite.
dvec3 unit_direction(dvec3 direction);

// Makes the rays of batches and traces them.
class RayGridTrace {
  public:
    // Syncs the accelerator, which must not change until the last batch is done.
    RayGridTrace(AbstractAccel& accel, const RayGridPlan& plan);

    // Recorded work is submitted on the way if it might take too long.
    void record(Commands& commands, RayBatch batch);
    // Submits the recorded work, waits and learns how long it takes.
    void finish(Commands& commands) { pace_.finish(commands); }
    // Holds the last batch; its first hit is that of the batch's first ray.
    const Buffer& hits() const { return hits_; }

  private:
    AbstractAccel& accel_;
    RayGrid grid_;
    Kernel<GridRaysArgs> kernel_;
    Buffer rays_, hits_;
    Pace pace_;
};

// illuminate() in two steps, for processes that share its rays.
std::uint64_t grid_ray_count(const Faces& faces, const IlluminationDesc& desc);

// Counts the hits of rays [first, last) of the grid; both are even, or the number of rays. Counts of parts add up to
// those of all. There is one entry per group, and one for all groups.
std::vector<GroupCount> count_light(AbstractAccel& accel, const Faces& faces, const IlluminationDesc& desc,
                                    std::uint64_t first, std::uint64_t last);

// Makes the result of the counts of all rays.
Illumination illumination_of(const Faces& faces, const IlluminationDesc& desc, std::span<const GroupCount> hits);

}  // namespace twinray
