// SPDX-License-Identifier: MIT
// Counts how often rays cross a closed mesh, on the device.
#pragma once

#include <span>
#include <vector>

#include "engine/accel/trace_desc.h"
#include <twinray/abstract_accel.h>
#include "engine/core/kernel.h"

namespace twinray {

// Counts how often rays cross the triangles of a scene, which closest hits do not show: an edge that is hit twice, or a
// far wall that is lost behind a near one.
class CrossingCounter {
  public:
    // Compiles the kernel. Hardware needs ray queries (Feature::kernel_queries).
    CrossingCounter(Context& context, bool is_software, Level level);

    // Returns the number of hits of each ray in (t_min, t_max). `accel` is of the requested kind, synced, and all its
    // instances are non-opaque (InstanceOptions): opaque ones count as nothing, and hide what lies behind them. A
    // triangle that a driver offers more than once, as it may, counts once among the first 16.
    std::vector<uint> count(const AbstractAccel& accel, std::span<const Ray> rays) const;

  private:
    struct Args {  // as shaders/suite/crossings.comp declares them
        std::uint64_t scene;
        Ref<Ray> rays;
        Uints counts;
        uint count;
        uint padding = 0;
    };
    Kernel<Args> kernel_;
};

}  // namespace twinray
