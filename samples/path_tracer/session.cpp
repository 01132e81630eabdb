// SPDX-License-Identifier: MIT
#include "samples/path_tracer/session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/accel/scene_push.h"
#include "engine/core/error.h"
#include "engine/scene/shapes.h"
#include "hwtlas/hw_tlas.h"
#include "samples/path_tracer/camera.h"
#include "swtlas/sw_tlas.h"

namespace twinray::path_tracer {
namespace {

constexpr float default_aspect = 4.0f / 3.0f;
constexpr uint default_height = 480;

Scene load(const Options& options) {
    const std::string builtin = "builtin:", name = options.scene.string();
    if (name.rfind(builtin, 0) != 0) return load_scene(options.scene);
    if (name == builtin + "cornell-box") return cornell_box_scene();
    fail("'", name, "': unknown; there is builtin:cornell-box");
}

// Before the work, not after it.
void check_folder(const std::filesystem::path& file) {
    if (file.empty()) return;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder))
        fail("'", file.string(), "': there is no folder '", folder.string(), "'");
}

const Camera* chosen_camera(const Options& options, const Scene& scene) {
    if (options.camera < 0 || (scene.cameras.empty() && options.camera == 0)) return nullptr;
    const auto index = static_cast<std::size_t>(options.camera);
    if (index >= scene.cameras.size())
        fail("'", options.scene.string(), "': --camera ", index, " does not exist; the scene has ",
             scene.cameras.size());
    return &scene.cameras[index];
}

RenderSettings make_settings(const Options& options, const Scene& scene) {
    const Camera* camera = chosen_camera(options, scene);
    float aspect = camera ? camera->aspect.value_or(default_aspect) : default_aspect;
    RenderSettings settings;
    settings.samples = options.samples;
    settings.max_depth = options.max_depth;
    settings.seed = options.seed;
    const auto scaled = [](uint side, float factor) {
        return std::max(1u, static_cast<uint>(std::lround(static_cast<float>(side) * factor)));
    };
    settings.height = options.height  ? options.height
                      : options.width ? scaled(options.width, 1 / aspect)
                                      : default_height;
    settings.width = options.width ? options.width : scaled(settings.height, aspect);
    aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    settings.camera = camera_rays(camera ? *camera : frame_scene(scene, aspect), aspect);
    return settings;
}

}  // namespace

float Session::exposure(const Options& options, const Picture& picture) const {
    if (options.exposure) return *options.exposure;
    return is_default_sky ? 0 : automatic_exposure(picture);
}

Session make_session(const Options& options) {
    for (const std::filesystem::path& file : {options.output, options.json, options.cross_check}) check_folder(file);
    Session session;
    session.scene = load(options);
    if (!options.quiet)
        for (const std::string& warning : session.scene.warnings)
            std::fprintf(stderr, "path_tracer: %s\n", warning.c_str());
    session.settings = make_settings(options, session.scene);
    session.lights = collect_lights(session.scene);
    session.is_default_sky = options.environment.empty() && !has_lamps(session.scene);
    if (session.is_default_sky) session.environment = std::make_unique<EnvironmentMap>(default_sky());
    if (!options.environment.empty())
        session.environment = std::make_unique<EnvironmentMap>(load_hdr_image(options.environment));
    session.context = std::make_unique<Context>(context_desc(options));
    session.device_scene =
        std::make_unique<DeviceScene>(*session.context, session.scene, session.lights, session.environment.get());
    session.renderer = std::make_unique<Renderer>(*session.context, *session.device_scene, session.settings);
    return session;
}

std::unique_ptr<AbstractAccel> make_accel(Context& context, const Scene& scene, const std::string& kind) {
    std::unique_ptr<AbstractAccel> accel;
    if (kind == "hw")
        accel = std::make_unique<HwTlas>(context);
    else
        accel = std::make_unique<SwTlas>(context);
    push_scene(*accel, scene);
    accel->sync();
    return accel;
}

std::string chosen_accel(const Options& options, const Context& context) {
    if (!options.accel.empty()) return options.accel;
    return missing_for_hardware(context.facts()).empty() ? "hw" : "sw";
}

std::string trace_path(const AbstractAccel& accel) {
    const auto* hardware = dynamic_cast<const HwTlas*>(&accel);
    return hardware ? hardware->trace_path() : "compute";
}

std::string backend(const AbstractAccel& accel) { return dynamic_cast<const HwTlas*>(&accel) ? "hw" : "sw"; }

}  // namespace twinray::path_tracer
