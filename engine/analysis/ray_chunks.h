// SPDX-License-Identifier: MIT
// Rays from faces in chunks of equal parts of each replicate, as kernels make them.
#pragma once

#include "engine/analysis/estimate.h"
#include "engine/analysis/faces.h"
#include "twinray/glsl/cpp_sampling.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/view_factors.h"
#include "twinray/glsl/cpp_end.h"
static_assert(REPLICATES == replicate_count && CHUNK == REPLICATES * SAMPLES_OF_CHUNK);

constexpr std::uint64_t first_rays = 1024;  // before the first look at errors

}  // namespace twinray
