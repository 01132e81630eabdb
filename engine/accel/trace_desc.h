// SPDX-License-Identifier: MIT
// The arguments that kernels get from a TraceDesc.
#pragma once

#include <twinray/trace.h>

#include "engine/accel/trace_args.h"

namespace twinray {

// Returns whether trees consist of records (shaders/shared/compressed.h).
constexpr bool has_records(Layout layout) { return layout != Layout::bvh2; }
// Returns the most children that a node has.
constexpr uint width_of(Layout layout) { return layout == Layout::bvh2 ? 2 : layout == Layout::compressed8 ? 8 : 4; }

constexpr uint flags_of(Cull cull) { return cull == Cull::none ? 0 : cull == Cull::back ? CULL_BACK : CULL_FRONT; }

}  // namespace twinray
