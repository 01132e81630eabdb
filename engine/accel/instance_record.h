// SPDX-License-Identifier: MIT
// InstanceRecord for C++.
#pragma once

#include "engine/core/shader_bridge.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/instance.h"
#include "engine/core/bridge_end.h"

static_assert(sizeof(InstanceRecord) == 64);
}  // namespace twinray
