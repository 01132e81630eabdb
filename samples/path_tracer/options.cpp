// SPDX-License-Identifier: MIT
#include "samples/path_tracer/path_tracer.h"

#include <CLI/CLI.hpp>

#include <string_view>

#include "engine/core/platform.h"
#include "renderer/film_file.h"

namespace twinray::path_tracer {
namespace {

constexpr std::uint32_t max_side = 32768, max_samples = 1 << 20, max_max_depth = 10'000;

std::string check_output(const std::string& file) {
    return is_image_file(file) || is_film_file(file) ? "" : "'" + file + "' must end in .png, .exr or .film";
}

CLI::Option* add_output(CLI::App& app, std::filesystem::path& output) {
    return samples::add_path(
               app, "-o,--output,--outfile", output,
               "output: .png (tone mapped), .exr (linear), or .film (sums of samples, to merge or to resume)")
        ->required()
        ->check(CLI::Validator(check_output, "FILE.png|.exr|.film"));
}

// Adds the options for pictures made from films, of any origin.
void add_finish(CLI::App& app, std::optional<float>& exposure, std::filesystem::path& reference) {
    app.add_option("--exposure", exposure,
                   "exposure of a .png in stops; default: 0 under the default sky, else automatic")
        ->check(CLI::Range(-100.0f, 100.0f));
    samples::add_path(app, "--mse-reference-image", reference, "print the difference from this .exr or .hdr picture");
}

void add_files(CLI::App& app, Options& options) {
    samples::add_path(app, "scene", options.scene,
                      "scene file: .gltf, .glb, .obj, .ply or .stl, or builtin:cornell-box")
        ->required();
    CLI::Option* output = add_output(app, options.output);
    app.add_flag_callback(
           "--view",
           [&options, output] {
               options.view = true;
               output->required(false);
           },
           "open the scene in the window of `twinray view` instead of rendering it")
        ->trigger_on_parse();
    add_finish(app, options.exposure, options.reference);
    app.add_flag("--aovs", options.aovs,
                 "also write these layers to the .exr: albedo, normal, depth, instance and primitive of the first hit, "
                 "samples, variance");
    app.add_flag("--denoise", options.denoise,
                 "remove the picture's noise with Open Image Denoise, if that library is installed; films keep it");
    app.add_option("--variant", options.variant, "name of a material variant of the scene (KHR_materials_variants)");
    samples::add_path(app, "--environment", options.environment,
                      "environment map that lights the scene: latitude-longitude .hdr or .exr");
    samples::add_path(app, "--json", options.json,
                      "append one JSON line with what was rendered, and how fast, to this file");
    samples::add_path(
        app, "--cross-check", options.cross_check,
        "trace every ray with both accelerators and write a comparison to this file (.json or text). The "
        "pictures of both go to OUTPUT_hw and OUTPUT_sw, their differences to OUTPUT_difference. The exit "
        "status is 1 after an unexplained difference or a fault of twinray");
}

void add_stopping(CLI::App& app, Options& options) {
    app.add_option("--spp", options.samples, "paths per pixel; default: 16, or unlimited with --time or --target-error")
        ->check(CLI::Range(1u, max_samples));
    app.add_option("--time", options.seconds,
                   "stop after this many seconds; rendering stops at whichever limit comes first")
        ->check(CLI::Range(0.0, 1e9));
    app.add_option("--target-error", options.target_error,
                   "stop when the root mean square error of the pixels is this fraction of the mean luminance; each "
                   "pixel gets as many paths as it needs")
        ->check(CLI::Range(1e-6, 1.0));
    app.add_option("--write-partial-images", options.preview_seconds,
                   "write the unfinished picture after the first path, and then every this many seconds")
        ->check(CLI::Range(0.0, 1e9));
    app.add_option("--display-server", options.display_server,
                   "send the unfinished picture to a viewer with the protocol of tev, at HOST or HOST:PORT");
    app.add_option(
           "--checkpoint", options.checkpoint_seconds,
           "save the unfinished film to OUTPUT.film every this many seconds; it is removed when the picture is done")
        ->check(CLI::Range(0.0, 1e9))
        ->capture_default_str();
    app.add_flag("--keep-film", options.keep_film, "keep OUTPUT.film, to add paths later with --resume");
    app.add_flag(
        "--resume", options.resume,
        "continue from OUTPUT.film if it exists; the picture is the same, bit by bit, as without the interruption");
    app.add_option("--shard", options.shard,
                   "I/N renders every N-th path of each pixel, beginning with path I, counted from 0; `path_tracer "
                   "merge` joins the films");
}

void add_camera(CLI::App& app, Options& options) {
    CLI::Option* index =
        app.add_option("--camera", options.camera,
                       "index of a camera of the scene; -1, or a scene without cameras, frames the whole scene")
            ->check(CLI::Range(-1, 1 << 20))
            ->capture_default_str();
    CLI::Option* from =
        app.add_option("--look-from", options.look_from, "position of a camera, X Y Z, instead of one of the scene")
            ->expected(3)
            ->excludes(index);
    CLI::Option* at = app.add_option("--look-at", options.look_at, "point that this camera looks at, X Y Z")
                          ->expected(3)
                          ->needs(from);
    from->needs(at);
    app.add_option("--up", options.up, "direction that points up in the picture; default: 0 1 0")
        ->expected(3)
        ->needs(from);
    app.add_option("--fov", options.fov, "vertical field of view in degrees")
        ->check(CLI::Range(0.001f, 179.0f))
        ->needs(from)
        ->capture_default_str();
    app.add_option("--lens-radius", options.lens_radius,
                   "radius of the lens aperture in units of the scene; 0 makes everything sharp")
        ->check(CLI::Range(0.0f, 1e30f))
        ->capture_default_str();
    app.add_option("--focal-distance", options.focal_distance,
                   "distance from the camera to the plane in focus; default: the distance to --look-at")
        ->check(CLI::PositiveNumber);
}

void add_picture(CLI::App& app, Options& options) {
    app.add_option("--width", options.width,
                   "width in pixels; default: 640, or the height times the aspect ratio of the camera")
        ->check(CLI::Range(1u, max_side));
    app.add_option("--height", options.height, "height in pixels; default: 480")->check(CLI::Range(1u, max_side));
    app.add_option("--cropwindow", options.crop,
                   "part of the picture to render, as X0 X1 Y0 Y1 in fractions from 0 to 1")
        ->expected(4)
        ->check(CLI::Range(0.0f, 1.0f));
    app.add_option("--filter", options.filter,
                   "pixel filter: the pixel's square (box), a triangle of one pixel's radius, or a Gaussian with a "
                   "standard deviation of half a pixel")
        ->check(CLI::IsMember({"box", "triangle", "gaussian"}))
        ->option_text("box|triangle|gaussian [gaussian]");
    app.add_option("--seed", options.seed, "seed of the random numbers")->capture_default_str();
    app.add_option("--max-depth", options.max_depth,
                   "largest number of scattering events per path; 0 shows only emission")
        ->check(CLI::Range(0u, max_max_depth))
        ->capture_default_str();
}

void add_machine(CLI::App& app, Options& options) {
    samples::add_device_options(app, options, "enable the Vulkan validation layer");
    app.add_flag("--strict", options.strict, "treat unsupported parts of the scene's file as errors, not as warnings");
    app.add_flag("--stats", options.stats, "print the number of rays, GPU time by pass, and memory");
    app.add_flag("--all-features", options.all_features,
                 "use kernels with all features that any scene may need, to measure what leaving them out saves");
}

void add_merge(CLI::App& app, MergeOptions& options) {
    app.add_option_function<std::vector<std::string>>(
           "films",
           [&options](const std::vector<std::string>& words) {
               for (const std::string& word : words) options.films.push_back(platform::path_of(word));
           },
           "films of --shard, or any films that hold different paths of one picture")
        ->required();
    add_output(app, options.output);
    add_finish(app, options.exposure, options.reference);
    app.add_flag("--quiet", options.quiet, "print only errors");
}

// It comes after the options that they exclude.
void add_sequence(CLI::App& app, SequenceOptions& options) {
    constexpr uint most_frames = 1'000'000;
    CLI::Option* frames = app.add_option("--frames", options.frames,
                                         "render this many pictures of a moving scene: OUTPUT_0001.png and so on, or "
                                         "the number in place of #### in OUTPUT")
                              ->check(CLI::Range(1u, most_frames));
    app.add_option("--animation", options.animation,
                   "name or index of the animation; default: the first, or none with --turntable")
        ->needs(frames);
    app.add_option("--fps", options.fps,
                   "pictures per second of the animation; default: spread them evenly over the time range")
        ->check(CLI::PositiveNumber)
        ->needs(frames);
    app.add_option("--time-range", options.time_range,
                   "time range of the animation in seconds, as A:B; default: the whole animation")
        ->needs(frames);
    app.add_flag("--turntable", options.turntable, "move the camera once around the scene, about the vertical axis")
        ->needs(frames);
    for (const char* other : {"--cross-check", "--resume", "--keep-film", "--shard", "--checkpoint",
                              "--write-partial-images", "--mse-reference-image"})
        frames->excludes(app.get_option(other));
}

}  // namespace

ParsedOptions parse_options(int argc, char** argv) {
    ParsedOptions result;
    if (argc > 1 && std::string_view(argv[1]) == "merge") {
        CLI::App app("path_tracer merge: join films of one picture");
        add_merge(app, result.merge.emplace());
        result.exit_status = samples::parse(app, argc - 1, argv + 1, "path_tracer");
        return result;
    }
    CLI::App app("path_tracer: render a physically based picture of a glTF scene with either accelerator");
    app.footer(
        "`path_tracer merge A.film B.film ... -o OUT.png` joins films into one picture; see `path_tracer merge "
        "--help`");
    add_files(app, result.options);
    add_stopping(app, result.options);
    add_picture(app, result.options);
    add_camera(app, result.options);
    add_machine(app, result.options);
    for (const char* other : {"--accel", "--time", "--target-error", "--resume", "--shard", "--write-partial-images",
                              "--keep-film", "--mse-reference-image", "--aovs", "--denoise"})
        app.get_option("--cross-check")->excludes(other);
    app.get_option("--target-error")->excludes("--shard");
    for (const char* other :
         {"--camera", "--variant", "--environment", "--max-depth", "--seed", "--cropwindow", "--filter",
          "--lens-radius", "--focal-distance", "--spp", "--time", "--target-error", "--denoise"})
        app.get_option("--view")->excludes(other);
    add_sequence(app, result.options.sequence);
    result.exit_status = samples::parse(app, argc, argv, "path_tracer");
    return result;
}

}  // namespace twinray::path_tracer
