// SPDX-License-Identifier: MIT
// Random and evenly spread numbers and their warps, for C++: the same values as in kernels.
#pragma once

#include <glm/integer.hpp>

#include "twinray/glsl/cpp.h"

namespace twinray {
using glm::bitfieldReverse;

#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/random.h"
#include "twinray/glsl/sampling.h"
#include "twinray/glsl/sobol.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray
