// SPDX-License-Identifier: MIT
// A renderer that has Vulkan, memory and frames of its own, and lets twinray trace its shadows.
#include <cstdio>
#include <cstdlib>

#include "engine/core/error.h"
#include "engine/scene/shapes.h"
#include "samples/embed_renderer/report.h"

namespace twinray::embed_renderer {
namespace {

Scene load(const std::string& name) { return name == "builtin:cornell-box" ? cornell_box_scene() : load_scene(name); }

std::filesystem::path frame_file(const Options& options, uint frame) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%04u.png", frame);
    return options.output / name;
}

// With what TWINRAY_DISABLE, a comma-separated list of ray_query and ray_tracing_pipeline, leaves unused.
DeviceDesc device_desc(const Options& options, const Log& log) {
    ContextDesc used;
    if (const char* disabled = std::getenv("TWINRAY_DISABLE")) disable_features(used, disabled);
    return {.device = options.device,
            .validation = options.validation,
            .use_ray_query = used.use_ray_query,
            .use_ray_tracing_pipeline = used.use_ray_tracing_pipeline,
            .log = log};
}

int run(const Options& options) {
    if (!options.output.empty()) std::filesystem::create_directories(options.output);
    const Stage stage = make_stage(load(options.scene.string()), options.balls, !options.no_ground);
    const Log log = [is_silent = options.quiet && !options.validation](std::string_view message) {
        if (!is_silent)
            std::fprintf(stderr, "embed_renderer: %.*s\n", static_cast<int>(message.size()), message.data());
    };
    for (const std::string& warning : stage.scene.warnings) log(warning);
    if (options.strict && !stage.scene.warnings.empty())
        fail("'", options.scene.string(), "': ", stage.scene.warnings.size(),
             " warning(s), of which --strict allows none");
    const Device device(device_desc(options, log));
    std::vector<std::vector<PassTimer::Lap>> laps;
    {
        Renderer renderer(device, stage, options);
        RayCounts rays{};
        for (uint frame = 0; frame < options.frames; ++frame) {
            const FrameResult result = renderer.render(static_cast<float>(frame) / 64);
            laps.push_back(result.laps);
            rays = result.rays;
            if (!options.output.empty()) write_picture(frame_file(options, frame), result.picture, 0);
        }
        report(options, renderer.choice(), costs_of(laps), rays);
    }
    if (device.live_allocations() > 0) fail(device.live_allocations(), " allocations are left");
    return device.validation_message_count() > 0 ? 1 : 0;
}

}  // namespace
}  // namespace twinray::embed_renderer

int main(int argc, char** argv) {
    using namespace twinray::embed_renderer;
    try {
        const ParsedOptions parsed = parse_options(argc, argv);
        if (parsed.exit_status) return *parsed.exit_status;
        return run(parsed.options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "embed_renderer: %s\n", error.what());
        return 1;
    }
}
