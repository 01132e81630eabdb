// SPDX-License-Identifier: MIT
// The sort's kernel arguments for C++.
#pragma once

#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/sort.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray
