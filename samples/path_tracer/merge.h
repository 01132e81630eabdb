// SPDX-License-Identifier: MIT
// Parts of a picture that were rendered apart.
#pragma once

#include "samples/path_tracer/options.h"

namespace twinray::path_tracer {

// Films of one picture become one film or picture, the same in any order. Returns the exit status. Throws Error naming
// the files that do not belong together.
int merge_films(const MergeOptions& options);

}  // namespace twinray::path_tracer
