// SPDX-License-Identifier: MIT
// Command line of the sample.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "samples/particles/renderer.h"
#include "samples/support/program.h"

namespace twinray::particles {

struct Options : samples::DeviceOptions {
    std::filesystem::path output, json;
    uint frames = 100;
    uint count = 1000;
    uint seed = 1;
    PictureSize size;
};

// The options, or the exit status of a run that is over: help was shown (0) or the usage is wrong (2).
struct ParsedOptions {
    Options options;
    std::optional<int> exit_status;
};
ParsedOptions parse_options(int argc, char** argv);

}  // namespace twinray::particles
