// SPDX-License-Identifier: MIT
// The kernels of the path tracer: those of a plain scene, and those with all features.
#include <twinray/scene.h>

#include "engine/scene/rig.h"
#include "cli/kernels/kernel_list.h"
#include <twinray/geometry.h>
#include "renderer/cross_check.h"
#include "renderer/moving_scene.h"
#include "renderer/renderer.h"
#include "renderer/scene_upload.h"
#include <twinray/tlas.h>

namespace twinray::kernels {
namespace {

Scene plain_scene() {
    Scene scene = cornell_box_scene();
    for (Material& material : scene.materials) material.transmission = 0;
    scene.rig = std::make_shared<Rig>();
    return scene;
}

}  // namespace

void make_path_tracer_kernels(Context& context) {
    namespace pt = path_tracer;
    Scene scene = plain_scene();
    const pt::LocalLights lights = pt::collect_lights(scene);
    const pt::EnvironmentMap sky(pt::default_sky());
    SwTlas accel(context, {.compiles_in_background = false});
    push_scene(accel, scene);
    accel.sync();
    const pt::RenderSettings settings{.width = 8, .height = 8};
    for (const pt::SceneFeatures& features : {pt::features_of(scene, lights, nullptr), pt::all_features(scene)}) {
        pt::DeviceScene on_device(context, scene, lights, &sky, features);
        pt::Renderer renderer(context, on_device, settings);
        renderer.first_surfaces(accel);
        const pt::CrossChecker checker(context, accel, renderer, renderer.film_size());
        const pt::MovingScene moving(context, scene, on_device, accel);
    }
}

}  // namespace twinray::kernels
