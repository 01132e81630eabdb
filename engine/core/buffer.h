// SPDX-License-Identifier: MIT
// The alignment that the library itself uses for buffers.
#pragma once

#include <twinray/commands.h>

#include "engine/core/context.h"
#include "twinray/glsl/cpp.h"

namespace twinray {

// The alignment of data that is read a whole line at a time, on all CPUs that matter and most GPUs.
inline constexpr std::uint64_t cache_line_bytes = 64;

}  // namespace twinray
