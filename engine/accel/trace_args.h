// SPDX-License-Identifier: MIT
// TraceArgs, the features and the levels for C++.
#pragma once

#include "engine/core/ray.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/trace.h"
#include "engine/core/bridge_end.h"

static_assert(sizeof(TraceArgs) == 64);
}  // namespace twinray
