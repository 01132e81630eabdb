// SPDX-License-Identifier: MIT
// Balls that move, refit and change colour on the GPU: the host submits all frames, reads only the last picture, and
// reports the time, as text and as a line of JSON.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <twinray/tlas.h>
#include "samples/particles/particles.h"
#include "samples/support/program.h"
#include "samples/support/text.h"

namespace twinray::particles {
namespace {

struct Options : samples::DeviceOptions {
    std::filesystem::path output, json;
    uint frames = 100;
    uint count = 1000;
    uint seed = 1;
    PictureSize size;
};

constexpr uint max_side = 8192, max_frames = 100'000, max_count = 1'000'000;

void add_options(CLI::App& app, Options& options) {
    samples::add_path(app, "-o,--output", options.output,
                      "file for the last frame: .png, or .exr with linear radiance");
    samples::add_path(app, "--json", options.json,
                      "append one JSON line with what was done, and how fast, to this file");
    app.add_option("--frames", options.frames, "how many")->check(CLI::Range(1u, max_frames))->capture_default_str();
    app.add_option("--count", options.count, "particles")->check(CLI::Range(1u, max_count))->capture_default_str();
    app.add_option("--width", options.size.width, "pixels")->check(CLI::Range(1u, max_side))->capture_default_str();
    app.add_option("--height", options.size.height, "pixels")->check(CLI::Range(1u, max_side))->capture_default_str();
    app.add_option("--samples", options.size.samples, "rays per pixel: 1, 4, 9 or 16")
        ->check(CLI::IsMember({1u, 4u, 9u, 16u}))
        ->option_text("1|4|9|16 [" + std::to_string(options.size.samples) + "]");
    app.add_option("--seed", options.seed, "seed of the particles' positions")->capture_default_str();
    samples::add_device_options(app, options, "enable the Vulkan validation layer; exit with status 1 on any message");
}

struct RunTimes {
    double submit_ms = 0;                // until the host had submitted all frames
    double total_ms = 0;                 // until the GPU was done with them
    bool was_ahead = false;              // all frames were submitted before the GPU was done with the last
    std::vector<PassTiming> last_frame;  // of the GPU
};

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

RunTimes run_frames(Simulation& simulation, Renderer& renderer, uint frames) {
    Context& context = simulation.accel().context();
    context.wait_for_gpu();
    const auto start = Clock::now();
    for (uint frame = 0; frame < frames; ++frame) {
        simulation.step();
        renderer.draw();
    }
    RunTimes times;
    times.submit_ms = milliseconds_since(start);
    times.was_ahead = !context.is_reached(context.last_submission());
    context.wait_for_gpu();
    times.total_ms = milliseconds_since(start);
    times.last_frame = simulation.timings();
    for (const PassTiming& pass : renderer.timings()) times.last_frame.push_back(pass);
    return times;
}

// Prints unless quiet, and appends to the file of --json. Throws Error naming it.
void report(const Options& options, const AccelChoice& accel, const RunTimes& times) {
    const double frame_ms = times.total_ms / options.frames;
    if (!options.quiet) {
        std::printf("%u particles, %u x %u, %u frames by %s (%s): %.2f ms a frame; all were submitted after %.1f ms\n",
                    options.count, options.size.width, options.size.height, options.frames, name_of(accel),
                    accel.why.c_str(), frame_ms, times.submit_ms);
        for (const PassTiming& pass : times.last_frame) std::printf("  %-22s %9.3f ms\n", pass.name.c_str(), pass.ms);
    }
    nlohmann::json passes;
    for (const PassTiming& pass : times.last_frame) passes[pass.name] = pass.ms;
    const nlohmann::json line = {{"sample", "particles"},
                                 {"accel", name_of(accel)},
                                 {"accel_why", accel.why},
                                 {"count", options.count},
                                 {"frames", options.frames},
                                 {"width", options.size.width},
                                 {"height", options.size.height},
                                 {"samples", options.size.samples},
                                 {"frame_ms", frame_ms},
                                 {"submit_ms", times.submit_ms},
                                 {"total_ms", times.total_ms},
                                 {"was_ahead", times.was_ahead},
                                 {"pass_ms", passes}};
    samples::append_line(options.json, line.dump());
}

int run(const Options& options) {
    if (!options.output.empty() && !is_image_file(options.output))
        samples::fail("'", options.output.string(), "': its name must end in .png or .exr");
    Context context(samples::context_desc(options, "particles"));
    const AccelChoice choice = choose_accel(context.properties(), options.accel);
    const std::unique_ptr<AbstractAccel> accel = make_accel(context, choice);
    Simulation simulation(*accel, make_particles(options.count, options.seed));
    Renderer renderer(simulation, options.size);
    const RunTimes times = run_frames(simulation, renderer, options.frames);
    if (!options.output.empty()) write_image(options.output, renderer.picture(), 0);
    report(options, choice, times);
    return context.validation_messages().empty() ? 0 : 1;
}

}  // namespace
}  // namespace twinray::particles

int main(int argc, char** argv) {
    using namespace twinray::particles;
    return twinray::samples::run_program("particles", [&] {
        CLI::App app("particles: render moving balls, coloured by their speed, without the host in the loop");
        Options options;
        add_options(app, options);
        const std::optional<int> exit_status = twinray::samples::parse(app, argc, argv, "particles");
        return exit_status ? *exit_status : run(options);
    });
}
