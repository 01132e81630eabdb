// SPDX-License-Identifier: MIT
// Balls that move, refit and change colour on the GPU: the host submits all frames and reads the last picture alone.
#include <chrono>
#include <cstdio>

#include <twinray/context.h>
#include <twinray/tlas.h>
#include "samples/particles/report.h"
#include "samples/support/text.h"

namespace twinray::particles {
namespace {

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

int run(const Options& options) {
    if (!options.output.empty() && !is_image_file(options.output))
        samples::fail("'", options.output.string(), "': pictures are .png or .exr");
    Context context(samples::context_desc(options, "particles"));
    const AccelChoice choice = choose_accel(context.properties(), options.accel);
    const std::unique_ptr<AbstractAccel> accel = samples::make_accel(context, choice);
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
        const ParsedOptions parsed = parse_options(argc, argv);
        return parsed.exit_status ? *parsed.exit_status : run(parsed.options);
    });
}
