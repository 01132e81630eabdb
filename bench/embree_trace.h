// SPDX-License-Identifier: MIT
// Rays and hits of ours through Embree's calls for many rays.
#pragma once

#include <embree3/rtcore.h>

#include <span>

#include "bench/ray_batch.h"

namespace twinray::bench {

struct EmbreeTrace {
    RTCScene scene;
    Query query;
    std::span<const Ray> rays;
    std::span<Hit> hits;  // as many
};

// In packets of 8 (rtcIntersect8, rtcOccluded8), in the given order, with Embree's default flags.
void trace_packets(const EmbreeTrace& trace);

// In streams of 256 (rtcIntersect1M, rtcOccluded1M), told whether they are coherent.
void trace_streams(const EmbreeTrace& trace, bool is_coherent);

}  // namespace twinray::bench
