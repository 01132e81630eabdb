// SPDX-License-Identifier: MIT
#include "samples/path_tracer/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "renderer/camera.h"
#include "renderer/configuration.h"
#include "renderer/film_file.h"

#include "samples/support/files.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
using samples::lower_suffix;
namespace {

constexpr float default_aspect = 4.0f / 3.0f;
constexpr uint default_height = 480, default_samples = 16;
constexpr uint most_samples = 1 << 20;

Scene load_any(const Options& options) {
    const std::string builtin = "builtin:", name = options.scene.string();
    if (name.rfind(builtin, 0) != 0) return load_scene(options.scene);
    if (name == builtin + "cornell-box") return cornell_box_scene();
    if (name == builtin + "sunflower") return sunflower_scene();
    fail("'", name, "': unknown; must be builtin:cornell-box or builtin:sunflower");
}

void print_notes(const Scene& scene, const Options& options) {
    if (!options.quiet && scene.origin != dvec3(0))
        std::fprintf(stderr, "path_tracer: scene moved to local origin %s\n", origin_text(scene.origin).c_str());
    std::vector<std::string> warnings = scene.warnings;
    for (std::string& stopped : stopped_lights(scene)) warnings.push_back(std::move(stopped));
    samples::report_warnings(warnings, options.scene, "path_tracer", options.strict, options.quiet);
}

Scene load(const Options& options) {
    Scene scene = load_any(options);
    if (options.sequence.plays_animation()) show_hidden(scene);
    if (!options.variant.empty()) apply_variant(scene, options.variant);
    return scene;
}

template <class T>
Vec<3, T> vector_of(const std::vector<T>& values) {
    return {values[0], values[1], values[2]};
}

// Returns nothing if the whole scene is framed.
std::optional<Camera> chosen_camera(const Options& options, const Scene& scene) {
    if (!options.look_from.empty())
        return look_camera(vec3(vector_of(options.look_from) - scene.origin),
                           vec3(vector_of(options.look_at) - scene.origin), vector_of(options.up), options.fov);
    if (options.camera < 0 || (scene.cameras.empty() && options.camera == 0)) return {};
    const auto index = static_cast<std::size_t>(options.camera);
    if (index >= scene.cameras.size())
        fail("'", options.scene.string(), "': --camera ", index, " does not exist; the scene has ",
             scene.cameras.size());
    return scene.cameras[index];
}

float aspect_of(const RenderSettings& settings) {
    return static_cast<float>(settings.width) / static_cast<float>(settings.height);
}

// Rounds as pbrt-v4 does.
Crop crop_of(const std::vector<float>& window, uint width, uint height) {
    const auto edge = [](float fraction, uint side) {
        return static_cast<uint>(std::ceil(fraction * static_cast<float>(side)));
    };
    const uint x0 = edge(window[0], width), x1 = edge(window[1], width);
    const uint y0 = edge(window[2], height), y1 = edge(window[3], height);
    if (x1 <= x0 || y1 <= y0)
        fail("--cropwindow ", window[0], ' ', window[1], ' ', window[2], ' ', window[3], ": no pixel of ", width, " x ",
             height, " is inside; X0 X1 Y0 Y1 are fractions, from left to right and from top to bottom");
    return {x0, y0, x1 - x0, y1 - y0};
}

uint filter_of(const std::string& name) {
    return name == "box" ? FILTER_BOX : name == "triangle" ? FILTER_TRIANGLE : FILTER_GAUSSIAN;
}

void set_lens(CameraRays& camera, const Options& options) {
    if (options.lens_radius > 0 && !options.focal_distance && options.look_at.empty())
        fail("--lens-radius ", options.lens_radius, ": requires --focal-distance, or --look-at at the point in focus");
    camera.lens_radius = options.lens_radius;
    if (options.look_at.empty() || options.focal_distance)
        camera.focal_distance = options.focal_distance.value_or(0);
    else
        camera.focal_distance = static_cast<float>(length(vector_of(options.look_at) - vector_of(options.look_from)));
}

RenderSettings make_settings(const Options& options, const Scene& scene) {
    const std::optional<Camera> camera = chosen_camera(options, scene);
    const float aspect = camera ? camera->aspect.value_or(default_aspect) : default_aspect;
    RenderSettings settings;
    settings.samples = options.samples.value_or(default_samples);
    settings.block_size = options.target_error ? adaptive_block_size : 1;
    settings.max_depth = options.max_depth;
    settings.seed = options.seed;
    settings.is_timed = options.stats;
    const auto scaled = [](uint side, float factor) {
        return std::max(1u, static_cast<uint>(std::lround(static_cast<float>(side) * factor)));
    };
    settings.height = options.height  ? options.height
                      : options.width ? scaled(options.width, 1 / aspect)
                                      : default_height;
    settings.width = options.width ? options.width : scaled(settings.height, aspect);
    settings.camera = rays_of(options, camera_of(options, scene, settings), settings);
    settings.filter = filter_of(options.filter);
    if (!options.crop.empty()) settings.crop = crop_of(options.crop, settings.width, settings.height);
    return settings;
}

StoppingRules make_rules(const Options& options) {
    const bool has_other = options.seconds || options.target_error;
    constexpr uint pilot = adaptive_block_size * pilot_blocks;
    if (options.target_error && options.samples.value_or(pilot) < pilot)
        fail("--target-error with --spp ", *options.samples, ": errors are estimated from at least ", pilot);
    return {options.samples.value_or(has_other ? most_samples : default_samples), options.seconds,
            options.target_error};
}

// Returns the part of the picture that each of many ranks renders, or that the options ask for.
Shard make_shard(const Options& options, const Ranks& ranks) {
    if (ranks.count() > 1) {
        if (!options.shard.empty() || options.target_error || !options.cross_check.empty())
            fail("--shard, --target-error and --cross-check do not work under mpirun, where ranks share the samples");
        return {ranks.index(), ranks.count()};
    }
    if (options.shard.empty()) return {};
    Shard shard;
    char slash = 0;
    std::istringstream in(options.shard);
    if (!(in >> shard.index >> slash >> shard.count) || slash != '/' || !in.eof() || shard.index >= shard.count ||
        options.shard.find('-') != std::string::npos)
        fail("--shard '", options.shard, "': must be I/N with I from 0 to N - 1");
    if (!is_film_file(options.output))
        fail("--shard ", options.shard, ": its output '", options.output.string(), "' must end in .film");
    return shard;
}

ContextDesc desc_for(const Options& options, const Ranks& ranks) {
    ContextDesc desc = samples::context_desc(options, "path_tracer");
    desc.pipeline_folder = user_pipeline_folder();
    if (ranks.count() > 1 && options.device.empty())
        desc.device = std::to_string(samples::device_of_rank(list_devices(), ranks.local_index()));
    return desc;
}

}  // namespace

Camera camera_of(const Options& options, const Scene& scene, const RenderSettings& settings) {
    const std::optional<Camera> camera = chosen_camera(options, scene);
    return camera ? *camera : frame_scene(scene, aspect_of(settings));
}

bool is_framing(const Options& options, const Scene& scene) { return !chosen_camera(options, scene); }

CameraRays rays_of(const Options& options, const Camera& camera, const RenderSettings& settings) {
    CameraRays rays = camera_rays(camera, aspect_of(settings));
    set_lens(rays, options);
    return rays;
}

void check_folder(const std::filesystem::path& file) {
    if (file.empty()) return;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder))
        fail("'", file.string(), "': there is no folder '", folder.string(), "'");
}

Session make_session(const Options& options, const Ranks& ranks) {
    for (const std::filesystem::path& file : {options.output, options.json, options.cross_check}) check_folder(file);
    if (options.aovs && lower_suffix(options.output) != ".exr")
        fail("--aovs: '", options.output.string(), "' must end in .exr");
    if (options.denoise && !is_image_file(options.output))
        fail("--denoise: '", options.output.string(), "' must be a picture, .png or .exr");
    Session session;
    if (options.denoise) session.denoiser = std::make_unique<Denoiser>();
    session.scene = load(options);
    print_notes(session.scene, options);
    session.rules = make_rules(options);
    session.shard = make_shard(options, ranks);
    session.settings = make_settings(options, session.scene);
    session.lights = collect_lights(session.scene);
    const bool is_default_sky = options.environment.empty() && !has_lamps(session.scene);
    if (is_default_sky) session.environment = std::make_unique<EnvironmentMap>(default_sky());
    if (!options.environment.empty())
        session.environment = std::make_unique<EnvironmentMap>(load_hdr_image(options.environment));
    session.configuration =
        configuration_of(session.settings, session.scene, session.lights, session.environment.get(), is_default_sky);
    session.context = std::make_unique<Context>(desc_for(options, ranks));
    session.accel = choose_accel(session.context->properties(), options.accel);
    session.device_scene = std::make_unique<DeviceScene>(
        *session.context, session.scene, session.lights, session.environment.get(),
        options.all_features ? all_features(session.scene)
                             : features_of(session.scene, session.lights, session.environment.get()));
    session.renderer = std::make_unique<Renderer>(*session.context, *session.device_scene, session.settings);
    return session;
}

std::unique_ptr<AbstractAccel> make_accel(Context& context, const Scene& scene, const AccelChoice& choice) {
    // The scene also has the meshes.
    std::unique_ptr<AbstractAccel> accel = twinray::make_accel(context, choice, {.keeps_meshes = false});
    push_scene(*accel, scene);
    accel->sync();
    return accel;
}

std::string trace_path(const AbstractAccel& accel) {
    const auto* hardware = dynamic_cast<const HwTlas*>(&accel);
    return hardware ? hardware->trace_path() : "compute";
}

}  // namespace twinray::path_tracer
