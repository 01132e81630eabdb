// SPDX-License-Identifier: MIT
// TraceArgs, the features and the levels for C++, and the data of a TraceDesc for kernels.
#pragma once

#include <twinray/trace.h>

#include "engine/core/ray.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/trace.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(TraceArgs) == 64);

// Returns whether trees consist of records (shaders/shared/compressed.h).
constexpr bool has_records(Layout layout) { return layout != Layout::bvh2; }
// Returns the most children that a node has.
constexpr uint width_of(Layout layout) { return layout == Layout::bvh2 ? 2 : layout == Layout::compressed8 ? 8 : 4; }

constexpr uint flags_of(Cull cull) { return cull == Cull::none ? 0 : cull == Cull::back ? CULL_BACK : CULL_FRONT; }

}  // namespace twinray
