// SPDX-License-Identifier: MIT
// The sort's kernel arguments for C++.
#pragma once

#include "engine/core/shader_bridge.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/sort.h"
#include "engine/core/bridge_end.h"
}  // namespace twinray
