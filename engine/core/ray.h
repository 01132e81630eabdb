// SPDX-License-Identifier: MIT
// Ray, Hit and which triangles can be hit, for C++.
#pragma once

#include <cmath>

#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/rays.h"
#include "twinray/glsl/triangle.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 32);
}  // namespace twinray
