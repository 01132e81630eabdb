// SPDX-License-Identifier: MIT
#include "samples/particles/options.h"

#include <CLI/CLI.hpp>

namespace twinray::particles {
namespace {

constexpr uint max_side = 8192, max_frames = 100'000, max_count = 1'000'000;

void add_options(CLI::App& app, Options& options) {
    app.add_option("-o,--output", options.output, "the last frame: .png, or .exr with linear radiance");
    app.add_option("--json", options.json, "append one line with what was done and how fast");
    app.add_option("--frames", options.frames, "how many")->check(CLI::Range(1u, max_frames))->capture_default_str();
    app.add_option("--count", options.count, "particles")->check(CLI::Range(1u, max_count))->capture_default_str();
    app.add_option("--width", options.size.width, "pixels")->check(CLI::Range(1u, max_side))->capture_default_str();
    app.add_option("--height", options.size.height, "pixels")->check(CLI::Range(1u, max_side))->capture_default_str();
    app.add_option("--samples", options.size.samples, "rays of a pixel: 1, 4, 9 or 16")
        ->check(CLI::IsMember({1u, 4u, 9u, 16u}))
        ->option_text("1|4|9|16 [" + std::to_string(options.size.samples) + "]");
    app.add_option("--seed", options.seed, "of where the particles start")->capture_default_str();
    samples::add_device_options(app, options, "Khronos validation layer; exit 1 on any message");
}

}  // namespace

ParsedOptions parse_options(int argc, char** argv) {
    CLI::App app("particles: moving balls, coloured by their speed, without the host in the loop");
    ParsedOptions result;
    add_options(app, result.options);
    result.exit_status = samples::parse(app, argc, argv, "particles");
    return result;
}

}  // namespace twinray::particles
