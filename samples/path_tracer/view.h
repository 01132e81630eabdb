// SPDX-License-Identifier: MIT
// The window of `twinray view` instead of a picture.
#pragma once

#include "samples/path_tracer/options.h"

namespace twinray::path_tracer {

// Becomes `twinray view` with this scene, camera and device: the command beside this program, else the one in PATH.
// Throws Error where there is none.
[[noreturn]] void view(const Options& options);

}  // namespace twinray::path_tracer
