// SPDX-License-Identifier: MIT
#include "samples/path_tracer/options.h"

#include <CLI/CLI.hpp>

#include <cstdlib>

#include "engine/core/error.h"
#include "samples/path_tracer/image_io.h"

namespace twinray::path_tracer {
namespace {

constexpr std::uint32_t max_side = 32768, max_samples = 1 << 20, max_max_depth = 10'000;

std::string check_picture(const std::string& file) {
    return is_picture_file(file) ? "" : "'" + file + "' must end in .png or .exr";
}

void add_files(CLI::App& app, Options& options) {
    app.add_option("scene", options.scene, ".gltf, .glb, .obj, .ply or .stl, or builtin:cornell-box")->required();
    app.add_option("-o,--output", options.output, "picture: .png (tone mapped) or .exr (linear)")
        ->required()
        ->check(CLI::Validator(check_picture, "FILE.png|.exr"));
    app.add_option("--environment", options.environment, "light from all around: latitude-longitude .hdr or .exr");
    app.add_option("--json", options.json, "append one line with what was rendered and how fast");
    app.add_option("--cross-check", options.cross_check,
                   "trace every ray with both accelerators and write what differs, .json or text; the pictures of both "
                   "go to OUTPUT_hw and OUTPUT_sw, where they differ to OUTPUT_difference; exit 1 on an unexplained "
                   "difference or a fault of ours");
}

void add_picture(CLI::App& app, Options& options) {
    app.add_option("--spp", options.samples, "paths per pixel")
        ->check(CLI::Range(1u, max_samples))
        ->capture_default_str();
    app.add_option("--width", options.width, "pixels; default: 640, or as the camera's aspect asks")
        ->check(CLI::Range(1u, max_side));
    app.add_option("--height", options.height, "pixels; default: 480")->check(CLI::Range(1u, max_side));
    app.add_option("--seed", options.seed, "of the random numbers")->capture_default_str();
    app.add_option("--max-depth", options.max_depth, "scatterings of a path; 0 shows only what emits")
        ->check(CLI::Range(0u, max_max_depth))
        ->capture_default_str();
    app.add_option("--camera", options.camera,
                   "which camera of the scene; -1 frames the whole scene, as do scenes without")
        ->check(CLI::Range(-1, 1 << 20))
        ->capture_default_str();
    app.add_option("--exposure", options.exposure, "stops, for .png; default: 0 under the default sky, else automatic")
        ->check(CLI::Range(-100.0f, 100.0f));
}

void add_machine(CLI::App& app, Options& options) {
    app.add_option("--accel", options.accel, "hw (ray tracing extensions) or sw (compute); default: hw where possible")
        ->check(CLI::IsMember({"hw", "sw"}));
    app.add_option("--device", options.device, "index, or a part of the name");
    app.add_flag("--validation", options.validation, "Khronos validation layer");
    app.add_flag("--quiet", options.quiet, "errors only");
}

}  // namespace

ParsedOptions parse_options(int argc, char** argv) {
    CLI::App app("path_tracer: a physically based picture of a glTF scene, by either accelerator");
    ParsedOptions result;
    add_files(app, result.options);
    add_picture(app, result.options);
    add_machine(app, result.options);
    app.get_option("--cross-check")->excludes("--accel");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        result.exit_status = app.exit(help);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "path_tracer: %s (see path_tracer --help)\n", error.what());
        result.exit_status = 2;
    }
    return result;
}

ContextDesc context_desc(const Options& options) {
    ContextDesc desc;
    desc.name = "path_tracer";
    desc.device = options.device;
    desc.validation = options.validation;
    desc.pipeline_folder = user_pipeline_folder();
    desc.log = [is_silent = options.quiet && !options.validation](std::string_view message) {
        if (!is_silent) std::fprintf(stderr, "path_tracer: %.*s\n", static_cast<int>(message.size()), message.data());
    };
    if (const char* disabled = std::getenv("TWINRAY_DISABLE")) disable_features(desc, disabled);
    return desc;
}

}  // namespace twinray::path_tracer
