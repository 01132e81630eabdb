// SPDX-License-Identifier: MIT
// Counts hits by groups of faces on the device; the arguments of the kernel.
#pragma once

#include "engine/analysis/faces.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/count_faces.h"
#include "twinray/glsl/cpp_end.h"
static_assert(sizeof(GroupCount) == 8 && sizeof(CountFacesArgs) == 48);

}  // namespace twinray
