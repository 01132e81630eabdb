// SPDX-License-Identifier: MIT
#include "samples/path_tracer/session.h"

#include <CLI/CLI.hpp>

#include <string_view>

#include "renderer/film_file.h"

namespace twinray::path_tracer {
namespace {

constexpr std::uint32_t max_side = 32768, max_samples = 1 << 20, max_max_depth = 10'000;

std::string check_output(const std::string& file) {
    return is_image_file(file) || is_film_file(file) ? "" : "'" + file + "' must end in .png, .exr or .film";
}

CLI::Option* add_output(CLI::App& app, std::filesystem::path& output) {
    return app
        .add_option("-o,--output,--outfile", output,
                    "picture: .png (tone mapped) or .exr (linear); or .film: sums to merge or to resume")
        ->required()
        ->check(CLI::Validator(check_output, "FILE.png|.exr|.film"));
}

// Adds the options for pictures made from films, of any origin.
void add_finish(CLI::App& app, std::optional<float>& exposure, std::filesystem::path& reference) {
    app.add_option("--exposure", exposure, "stops, for .png; default: 0 under the default sky, else automatic")
        ->check(CLI::Range(-100.0f, 100.0f));
    app.add_option("--mse-reference-image", reference, "print how the picture differs from this .exr or .hdr");
}

void add_files(CLI::App& app, Options& options) {
    app.add_option("scene", options.scene, ".gltf, .glb, .obj, .ply or .stl, or builtin:cornell-box")->required();
    CLI::Option* output = add_output(app, options.output);
    app.add_flag_callback(
           "--view",
           [&options, output] {
               options.view = true;
               output->required(false);
           },
           "open the scene in the window of twinray view instead")
        ->trigger_on_parse();
    add_finish(app, options.exposure, options.reference);
    app.add_flag(
        "--aovs", options.aovs,
        "write to the .exr, too: albedo, normal, depth, instance and primitive of what is seen first, samples, "
        "variance");
    app.add_option("--variant", options.variant, "which of the scene's sets of materials (KHR_materials_variants)");
    app.add_option("--environment", options.environment, "light from all around: latitude-longitude .hdr or .exr");
    app.add_option("--json", options.json, "append one line with what was rendered and how fast");
    app.add_option("--cross-check", options.cross_check,
                   "trace every ray with both accelerators and write what differs, .json or text; the pictures of both "
                   "go to OUTPUT_hw and OUTPUT_sw, where they differ to OUTPUT_difference; exit 1 on an unexplained "
                   "difference or a fault of ours");
}

void add_stopping(CLI::App& app, Options& options) {
    app.add_option("--spp", options.samples, "paths per pixel; default: 16, or no limit with --time or --target-error")
        ->check(CLI::Range(1u, max_samples));
    app.add_option("--time", options.seconds, "seconds after which to stop")->check(CLI::Range(0.0, 1e9));
    app.add_option("--target-error", options.target_error,
                   "stop when the root mean square error of the pixels is this share of the mean luminance; each pixel "
                   "gets as many paths as it needs")
        ->check(CLI::Range(1e-6, 1.0));
    app.add_option("--write-partial-images", options.preview_seconds,
                   "write the picture as it is after the first path and every so many seconds")
        ->check(CLI::Range(0.0, 1e9));
    app.add_option("--display-server", options.display_server,
                   "show the picture as it grows in a viewer with the protocol of tev, at HOST or HOST:PORT");
    app.add_option("--checkpoint", options.checkpoint_seconds,
                   "save what is there to OUTPUT.film every so many seconds; it goes when the picture is done")
        ->check(CLI::Range(0.0, 1e9))
        ->capture_default_str();
    app.add_flag("--keep-film", options.keep_film, "let OUTPUT.film stay, to add paths later with --resume");
    app.add_flag("--resume", options.resume,
                 "go on from OUTPUT.film, if it is there; the picture is the same, bit by bit");
    app.add_option("--shard", options.shard,
                   "I/N: every N-th path of each pixel from the I-th on, I from 0; for 'path_tracer merge'");
}

void add_camera(CLI::App& app, Options& options) {
    CLI::Option* index = app.add_option("--camera", options.camera,
                                        "which camera of the scene; -1 frames the whole scene, as do scenes without")
                             ->check(CLI::Range(-1, 1 << 20))
                             ->capture_default_str();
    CLI::Option* from =
        app.add_option("--look-from", options.look_from, "a camera of one's own: where it stands, X Y Z")
            ->expected(3)
            ->excludes(index);
    CLI::Option* at = app.add_option("--look-at", options.look_at, "and what it looks at")->expected(3)->needs(from);
    from->needs(at);
    app.add_option("--up", options.up, "direction that is up in the picture; default: 0 1 0")->expected(3)->needs(from);
    app.add_option("--fov", options.fov, "vertical field of view in degrees")
        ->check(CLI::Range(0.001f, 179.0f))
        ->needs(from)
        ->capture_default_str();
    app.add_option("--lens-radius", options.lens_radius, "of the aperture, in units of the scene; 0: all is sharp")
        ->check(CLI::Range(0.0f, 1e30f))
        ->capture_default_str();
    app.add_option("--focal-distance", options.focal_distance,
                   "from the camera to the plane that is sharp; default: where --look-at lies")
        ->check(CLI::PositiveNumber);
}

void add_picture(CLI::App& app, Options& options) {
    app.add_option("--width", options.width, "pixels; default: 640, or as the camera's aspect asks")
        ->check(CLI::Range(1u, max_side));
    app.add_option("--height", options.height, "pixels; default: 480")->check(CLI::Range(1u, max_side));
    app.add_option("--cropwindow", options.crop,
                   "X0 X1 Y0 Y1: the part of the picture to render, in fractions from 0 to 1")
        ->expected(4)
        ->check(CLI::Range(0.0f, 1.0f));
    app.add_option("--filter", options.filter,
                   "what of the picture a pixel shows: its square (box), or its surroundings within a pixel (triangle) "
                   "or with a standard deviation of half a pixel (gaussian)")
        ->check(CLI::IsMember({"box", "triangle", "gaussian"}))
        ->option_text("box|triangle|gaussian [gaussian]");
    app.add_option("--seed", options.seed, "of the random numbers")->capture_default_str();
    app.add_option("--max-depth", options.max_depth, "scatterings of a path; 0 shows only what emits")
        ->check(CLI::Range(0u, max_max_depth))
        ->capture_default_str();
}

void add_machine(CLI::App& app, Options& options) {
    samples::add_device_options(app, options, "Khronos validation layer");
    app.add_flag("--strict", options.strict, "what is not understood of the scene's file is an error, not a warning");
    app.add_flag("--stats", options.stats, "print what was traced, the device's time by pass, and memory");
    app.add_flag("--all-features", options.all_features,
                 "leave out nothing that other scenes would need, to measure what leaving out saves");
}

void add_merge(CLI::App& app, MergeOptions& options) {
    app.add_option("films", options.films, "of --shard, or any that hold different paths of one picture")->required();
    add_output(app, options.output);
    add_finish(app, options.exposure, options.reference);
    app.add_flag("--quiet", options.quiet, "errors only");
}

// It comes after the options that they exclude.
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

}  // namespace

ParsedOptions parse_options(int argc, char** argv) {
    ParsedOptions result;
    if (argc > 1 && std::string_view(argv[1]) == "merge") {
        CLI::App app("path_tracer merge: films of one picture become one");
        add_merge(app, result.merge.emplace());
        result.exit_status = samples::parse(app, argc - 1, argv + 1, "path_tracer");
        return result;
    }
    CLI::App app("path_tracer: a physically based picture of a glTF scene, by either accelerator");
    app.footer(
        "path_tracer merge A.film B.film ... -o OUT.png: one picture of many films; see path_tracer merge --help");
    add_files(app, result.options);
    add_stopping(app, result.options);
    add_picture(app, result.options);
    add_camera(app, result.options);
    add_machine(app, result.options);
    for (const char* other : {"--accel", "--time", "--target-error", "--resume", "--shard", "--write-partial-images",
                              "--keep-film", "--mse-reference-image", "--aovs"})
        app.get_option("--cross-check")->excludes(other);
    app.get_option("--target-error")->excludes("--shard");
    for (const char* other : {"--camera", "--variant", "--environment", "--max-depth", "--seed", "--cropwindow",
                              "--filter", "--lens-radius", "--focal-distance", "--spp", "--time", "--target-error"})
        app.get_option("--view")->excludes(other);
    add_sequence(app, result.options.sequence);
    result.exit_status = samples::parse(app, argc, argv, "path_tracer");
    return result;
}

ContextDesc context_desc(const Options& options) {
    ContextDesc desc = samples::context_desc(options, "path_tracer");
    desc.pipeline_folder = user_pipeline_folder();
    return desc;
}

}  // namespace twinray::path_tracer
