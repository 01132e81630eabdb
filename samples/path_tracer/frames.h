// SPDX-License-Identifier: MIT
// Sequences of pictures.
#pragma once

#include "samples/path_tracer/options.h"
#include "renderer/ranks.h"

namespace twinray::path_tracer {

// --frames: picture after picture of a scene that moves, or is gone round. Returns the exit status: 128 + the signal
// that ended it early, else 0.
int render_frames(const Options& options, Ranks& ranks);

}  // namespace twinray::path_tracer
