// SPDX-License-Identifier: MIT
// A renderer that has Vulkan, memory and frames of its own, and lets twinray trace its shadows.
#include <cstdio>

#include <twinray/scene.h>

#include "samples/embed_renderer/report.h"
#include "samples/support/text.h"

namespace twinray::embed_renderer {
namespace {

Scene load(const std::string& name) { return name == "builtin:cornell-box" ? cornell_box_scene() : load_scene(name); }

std::filesystem::path frame_file(const Options& options, uint frame) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%04u.png", frame);
    return options.output / name;
}

DeviceDesc device_desc(const Options& options) {
    const ContextDesc used = samples::context_desc(options, "embed_renderer");
    return {.device = used.device,
            .validation = used.validation,
            .use_ray_query = used.use_ray_query,
            .use_ray_tracing_pipeline = used.use_ray_tracing_pipeline,
            .log = used.log};
}

int run(const Options& options) {
    if (!options.output.empty()) std::filesystem::create_directories(options.output);
    const Stage stage = make_stage(load(options.scene.string()), options.balls, !options.no_ground);
    samples::report_warnings(stage.scene.warnings, options.scene, "embed_renderer", options.strict, options.quiet);
    const Device device(device_desc(options));
    std::vector<std::vector<PassTimer::Lap>> laps;
    {
        Renderer renderer(device, stage, options);
        RayCounts rays{};
        for (uint frame = 0; frame < options.frames; ++frame) {
            const FrameResult result = renderer.render(static_cast<float>(frame) / 64);
            laps.push_back(result.laps);
            rays = result.rays;
            if (!options.output.empty()) write_image(frame_file(options, frame), result.picture, 0);
        }
        report(options, renderer.choice(), costs_of(laps), rays);
    }
    if (device.live_allocations() > 0) samples::fail(device.live_allocations(), " allocations are left");
    return device.validation_message_count() > 0 ? 1 : 0;
}

}  // namespace
}  // namespace twinray::embed_renderer

int main(int argc, char** argv) {
    using namespace twinray::embed_renderer;
    return twinray::samples::run_program("embed_renderer", [&] {
        const ParsedOptions parsed = parse_options(argc, argv);
        return parsed.exit_status ? *parsed.exit_status : run(parsed.options);
    });
}
