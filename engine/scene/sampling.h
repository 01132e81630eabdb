// SPDX-License-Identifier: MIT
// Random and evenly spread numbers and their warps, for C++: the same values as kernels get.
#pragma once

#include <glm/integer.hpp>

#include "engine/core/shader_bridge.h"

namespace twinray {
using glm::bitfieldReverse;
using glm::sqrt;

#include "engine/core/bridge_begin.h"
#include "shaders/sampling/random.h"
#include "shaders/sampling/sampling.h"
#include "shaders/sampling/sobol.h"
#include "engine/core/bridge_end.h"
}  // namespace twinray
