// SPDX-License-Identifier: MIT
// is_active_triangle for C++.
#pragma once

#include "engine/core/ray.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/triangle.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray
