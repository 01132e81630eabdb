// SPDX-License-Identifier: MIT
// Random and evenly spread numbers and their warps, for C++: the same values as kernels get.
#pragma once

#include <glm/integer.hpp>

#include "twinray/glsl/cpp.h"

namespace twinray {
using glm::bitfieldReverse;

#include "twinray/glsl/cpp_begin.h"
#include "shaders/sampling/random.h"
#include "shaders/sampling/sampling.h"
#include "shaders/sampling/sobol.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray
