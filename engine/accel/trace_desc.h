// SPDX-License-Identifier: MIT
// What kernels are told of a TraceDesc.
#pragma once

#include <twinray/trace.h>

#include "engine/accel/trace_args.h"

namespace twinray {

// Whether trees are of records (shaders/shared/compressed.h).
constexpr bool has_records(Layout layout) { return layout != Layout::bvh2; }
// How many children a node has at most.
constexpr uint width_of(Layout layout) { return layout == Layout::bvh2 ? 2 : layout == Layout::compressed8 ? 8 : 4; }

constexpr uint flags_of(Cull cull) { return cull == Cull::none ? 0 : cull == Cull::back ? CULL_BACK : CULL_FRONT; }

}  // namespace twinray
