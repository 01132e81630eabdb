// SPDX-License-Identifier: MIT
#pragma once

#include "samples/path_tracer/sequence.h"

namespace CLI {
class App;
}

namespace twinray::path_tracer {

// After the options that they exclude.
void add_sequence(CLI::App& app, SequenceOptions& options);

}  // namespace twinray::path_tracer
