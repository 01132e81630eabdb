// SPDX-License-Identifier: MIT
// HwScene for C++.
#pragma once

#include "engine/accel/world_bound.h"

namespace twinray {
using std::uint64_t;
#include "engine/core/bridge_begin.h"
#include "shaders/shared/hw_scene.h"
#include "engine/core/bridge_end.h"

static_assert(sizeof(HwGeometry) == 48 && sizeof(HwInstance) == 16 && sizeof(HwScene) == 16);
}  // namespace twinray
