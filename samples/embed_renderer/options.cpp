// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/options.h"

#include <CLI/CLI.hpp>

namespace twinray::embed_renderer {
namespace {

constexpr uint max_side = 8192, max_rays = 256, max_frames = 100'000, max_balls = 10'000;

void add_files(CLI::App& app, Options& options) {
    app.add_option("scene", options.scene, ".gltf, .glb, .obj, .ply or .stl, or builtin:cornell-box")->required();
    app.add_option("-o,--output", options.output, "folder for the frames, frame_0000.png and so on");
    app.add_option("--json", options.json, "append one line with what was rendered and how fast");
}

void add_picture(CLI::App& app, Options& options) {
    app.add_option("--frames", options.frames, "how many")->check(CLI::Range(1u, max_frames))->capture_default_str();
    app.add_option("--width", options.width, "pixels")->check(CLI::Range(1u, max_side))->capture_default_str();
    app.add_option("--height", options.height, "pixels")->check(CLI::Range(1u, max_side))->capture_default_str();
    app.add_option("--shadow-rays", options.shadow_rays, "per pixel; 0: no shadows")
        ->check(CLI::Range(0u, max_rays))
        ->capture_default_str();
    app.add_option("--ao-rays", options.ao_rays, "per pixel; 0: no ambient occlusion")
        ->check(CLI::Range(0u, max_rays))
        ->capture_default_str();
    app.add_option("--sun-angle", options.sun_angle, "degrees across the sun; 0: hard shadows")
        ->check(CLI::Range(0.0f, 90.0f))
        ->capture_default_str();
    app.add_option("--balls", options.balls, "that move around the scene")
        ->check(CLI::Range(1u, max_balls))
        ->capture_default_str();
    app.add_option("--camera", options.camera, "which camera of the scene; -1 frames the whole scene")
        ->check(CLI::Range(-1, 1 << 20))
        ->capture_default_str();
    app.add_flag("--no-ground", options.no_ground, "for scenes with a floor of their own");
}

void add_machine(CLI::App& app, Options& options) {
    samples::add_device_options(app, options, "Khronos validation layer; exit 1 on any message");
    app.add_flag("--strict", options.strict, "what is not understood of the scene's file is an error, not a warning");
}

}  // namespace

ParsedOptions parse_options(int argc, char** argv) {
    CLI::App app("embed_renderer: a rasteriser that lets twinray trace its shadows, by either accelerator");
    ParsedOptions result;
    add_files(app, result.options);
    add_picture(app, result.options);
    add_machine(app, result.options);
    result.exit_status = samples::parse(app, argc, argv, "embed_renderer");
    return result;
}

}  // namespace twinray::embed_renderer
