// SPDX-License-Identifier: MIT
// Instances, triangles and spawn points for C++: the same text that kernels include as twinray/glsl/spawn.glsl. Needs
// GLM.
#pragma once

#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/spawn.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray
