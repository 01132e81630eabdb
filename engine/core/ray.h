// SPDX-License-Identifier: MIT
// Ray and Hit for C++.
#pragma once

#include <cmath>

#include "engine/core/shader_bridge.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/ray.h"
#include "engine/core/bridge_end.h"

static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 32);
}  // namespace twinray
