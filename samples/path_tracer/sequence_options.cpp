// SPDX-License-Identifier: MIT
#include "samples/path_tracer/sequence_options.h"

#include <CLI/CLI.hpp>

namespace twinray::path_tracer {

void add_sequence(CLI::App& app, SequenceOptions& options) {
    constexpr uint most_frames = 1'000'000;
    CLI::Option* frames = app.add_option("--frames", options.frames,
                                         "so many pictures of a scene that moves: OUTPUT_0001.png and so on, or the "
                                         "number where OUTPUT has ####")
                              ->check(CLI::Range(1u, most_frames));
    app.add_option("--animation", options.animation,
                   "name or index of the animation; default: the first, or none with --turntable")
        ->needs(frames);
    app.add_option("--fps", options.fps,
                   "pictures in a second of the animation; default: they share the time range evenly")
        ->check(CLI::PositiveNumber)
        ->needs(frames);
    app.add_option("--time-range", options.time_range, "A:B, seconds of the animation; default: all of it")
        ->needs(frames);
    app.add_flag("--turntable", options.turntable, "the camera goes once round the scene, about the vertical axis")
        ->needs(frames);
    for (const char* other : {"--cross-check", "--resume", "--keep-film", "--shard", "--checkpoint",
                              "--write-partial-images", "--mse-reference-image"})
        frames->excludes(app.get_option(other));
}

}  // namespace twinray::path_tracer
