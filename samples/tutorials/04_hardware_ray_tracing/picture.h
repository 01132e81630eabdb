// SPDX-License-Identifier: MIT
// Pictures of the cage, by a kernel that traces and by batches.
#pragma once

#include <vector>

#include <twinray/scene.h>
#include <twinray/tlas.h>

#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "cage.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray

using namespace twinray;

// Pushes floor, cage and ball.
void push_cage(AbstractAccel& accel);
// Returns size * size pixels, row 0 on top. The accelerator must support kernels: Feature::kernel_queries.
std::vector<Rgb> picture_by_kernel(AbstractAccel& accel, uint size);
// The same with any accelerator: the host makes rays and reads hits, the device traces.
std::vector<Rgb> picture_by_batches(AbstractAccel& accel, uint size);
