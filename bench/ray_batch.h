// SPDX-License-Identifier: MIT
// Rays that backends trace, on the host and on the devices of those that want them there.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "engine/accel/trace_desc.h"
#include "engine/core/buffer.h"

namespace twinray::bench {

class RayBatch {
  public:
    // `is_coherent`: neighbours go the same way, which some backends want to be told.
    RayBatch(std::vector<Ray> rays, Query query, bool is_coherent)
        : rays_(std::move(rays)), query_(query), is_coherent_(is_coherent) {}

    std::span<const Ray> rays() const { return rays_; }
    Query query() const { return query_; }
    bool is_coherent() const { return is_coherent_; }

    struct DeviceBuffers {
        Buffer rays;
        Buffer hits;  // of the last trace there
    };
    // Uploaded when first asked for. The context must outlive the batch.
    const DeviceBuffers& on(Context& context) const;

  private:
    std::vector<Ray> rays_;
    Query query_;
    bool is_coherent_;
    mutable std::map<Context*, DeviceBuffers> on_devices_;
};

}  // namespace twinray::bench
