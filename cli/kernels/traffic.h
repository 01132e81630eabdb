// SPDX-License-Identifier: MIT
// How much memory a build moves: what a time on a device is to be compared with.
#pragma once

#include "engine/accel/trace_desc.h"

namespace twinray {

// Bytes a triangle that a build of SwTlas reads and writes: each array as often as a pass goes through it, a vertex for
// each corner. What caches save, or lines that are fetched in vain cost, is not in it. Records are counted as many as a
// tree may need, and the second sort, by 60-bit codes, which few meshes need, not at all.
struct BuildTraffic {
    double read = 0, written = 0;
};
BuildTraffic build_traffic(Layout layout, BuildQuality quality);

// Of a refit of vertices.
BuildTraffic refit_traffic(Layout layout);

}  // namespace twinray
