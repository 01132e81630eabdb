// SPDX-License-Identifier: MIT
// What the options ask for, made: scene, lights, camera, device and accelerators.
#pragma once

#include <memory>

#include <twinray/tlas.h>
#include "renderer/environment.h"
#include "renderer/lights.h"
#include "renderer/ranks.h"
#include "renderer/renderer.h"
#include "renderer/rounds.h"
#include "samples/path_tracer/options.h"

namespace twinray::path_tracer {

struct Session {
    Scene scene;
    LocalLights lights;
    std::unique_ptr<EnvironmentMap> environment;  // null: black
    RenderSettings settings;
    StoppingRules rules;
    Shard shard;
    Configuration configuration;
    std::unique_ptr<Context> context;
    AccelChoice accel;  // what traces, and why
    std::unique_ptr<DeviceScene> device_scene;
    std::unique_ptr<Renderer> renderer;
};

// Before the work, not after it. Throws Error where there is no folder for the file.
void check_folder(const std::filesystem::path& file);

// Throws Error naming the file, the option and the limit.
Session make_session(const Options& options, const Ranks& ranks);

// The camera that the options choose; one that frames the scene where is_framing().
Camera camera_of(const Options& options, const Scene& scene, const RenderSettings& settings);
bool is_framing(const Options& options, const Scene& scene);
// With the lens of the options.
CameraRays rays_of(const Options& options, const Camera& camera, const RenderSettings& settings);

// Holds the scene, built.
std::unique_ptr<AbstractAccel> make_accel(Context& context, const Scene& scene, const AccelChoice& choice);

// "compute", "ray query" or "ray tracing pipeline".
std::string trace_path(const AbstractAccel& accel);

}  // namespace twinray::path_tracer
