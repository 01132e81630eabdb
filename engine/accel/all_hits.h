// SPDX-License-Identifier: MIT
// Every hit of a ray, in order, for hosts: batches of closest hits, each behind the one before.
#pragma once

#include <span>
#include <vector>

#include <twinray/abstract_accel.h>
#include "engine/core/device_list.h"
#include "engine/core/ray.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/all_hits.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(RayHit) == 36);

struct HitsOfRays {
    std::vector<std::uint64_t> first;  // of each ray's hits, and at the end how many there are in all
    std::vector<Hit> hits;             // of each ray ascending by t, then by (instance, primitive)

    std::span<const Hit> of(std::size_t ray) const {
        return std::span(hits).subspan(first[ray], first[ray + 1] - first[ray]);
    }
};

// Finds every triangle that rays meet, each once, at level watertight: a closed surface is met as often from outside as
// from inside, and of the triangles around an edge or a corner SwTlas names exactly one a crossing. Filters of
// instances are not asked: what is non-opaque counts. Uses mask and cull of TraceDesc.
//
// Each call syncs, submits and waits. Memory is kept for the next one.
class AllHits {
  public:
    // Throws Error where kernels cannot trace the accelerator (Feature::kernel_queries).
    explicit AllHits(AbstractAccel& accel);

    // Throws Error for a scene with boxes, and one that says how many hits there are where they exceed max_hits().
    HitsOfRays operator()(std::span<const Ray> rays, const TraceDesc& desc = {});

    // 36 bytes of device memory each. Default: 2^27; at most 2^32 - 1.
    std::uint64_t max_hits() const { return found_.limit(); }
    void set_max_hits(std::uint64_t count) { found_.set_limit(count); }

  private:
    AbstractAccel& accel_;
    Kernel<AllHitsArgs> kernel_;
    Buffer rays_;
    DeviceList found_;
};

}  // namespace twinray
