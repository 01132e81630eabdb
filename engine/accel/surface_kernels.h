// SPDX-License-Identifier: MIT
// Kernels that find the surfaces of hits for the host.
#pragma once

#include "engine/accel/surface_tables.h"
#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/surface_args.h"
#include "twinray/glsl/cpp_end.h"

struct SurfaceKernels {
    explicit SurfaceKernels(Context& context);

    Kernel<SurfaceArgs> surfaces;
    Kernel<InterpolateArgs> interpolate;
};

}  // namespace twinray
