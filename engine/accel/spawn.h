// SPDX-License-Identifier: MIT
// Spawn points for C++: the same text that kernels get from twinray/spawn.glsl.
#pragma once

#include "engine/accel/instance_record.h"
#include "engine/core/triangle.h"

namespace twinray {
using glm::length;
using glm::normalize;

#include "engine/core/bridge_begin.h"
#include "shaders/shared/spawn.h"
#include "engine/core/bridge_end.h"
}  // namespace twinray
