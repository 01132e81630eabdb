// SPDX-License-Identifier: MIT
// The structs that kernels of the hardware accelerator share with C++.
#pragma once

#include "engine/accel/surface_area.h"
#include "engine/accel/world_bound.h"

namespace twinray {
using std::uint64_t;
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/hw_tlas_header.h"
#include "shaders/shared/hw_build.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(HwGeometry) == 48 && sizeof(HwInstance) == 16 && sizeof(HwTlasHeader) == 32 &&
              sizeof(HwTrianglesArgs) == 80 && sizeof(HwGatherArgs) == 40 && sizeof(HwAreasArgs) == 32);
}  // namespace twinray
