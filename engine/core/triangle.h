// SPDX-License-Identifier: MIT
// is_active_triangle for C++.
#pragma once

#include "engine/core/ray.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/triangle.h"
#include "engine/core/bridge_end.h"
}  // namespace twinray
