// SPDX-License-Identifier: MIT
// Spawn points for C++: the same text that kernels get from twinray/glsl/spawn.glsl.
#pragma once

#include "engine/accel/instance_record.h"
#include "engine/core/triangle.h"

namespace twinray {

#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/spawn.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray
