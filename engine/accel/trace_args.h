// SPDX-License-Identifier: MIT
// TraceArgs, the features and the levels for C++.
#pragma once

#include "engine/core/ray.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/trace.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(TraceArgs) == 64);
}  // namespace twinray
