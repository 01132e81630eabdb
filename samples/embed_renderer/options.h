// SPDX-License-Identifier: MIT
// Command line of the sample.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "twinray/glsl/cpp.h"
#include "samples/support/program.h"

namespace twinray::embed_renderer {

struct Options : samples::DeviceOptions {
    std::filesystem::path scene, output, json;  // output: a folder, or empty
    uint frames = 8;
    uint width = 960, height = 540;
    uint shadow_rays = 4;  // per pixel; 0: no shadows
    uint ao_rays = 4;      // likewise
    float sun_angle = 2;   // degrees across; 0: hard shadows
    uint balls = 12;
    int camera = -1;  // -1: frame the scene
    bool no_ground = false;
    bool strict = false;
};

// The options, or the exit status of a run that is over: help was shown (0) or the usage is wrong (2).
struct ParsedOptions {
    Options options;
    std::optional<int> exit_status;
};
ParsedOptions parse_options(int argc, char** argv);

}  // namespace twinray::embed_renderer
