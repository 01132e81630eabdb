// Small renders for tests.
#pragma once

#include <cmath>
#include <cstring>
#include <memory>

#include <twinray/scene.h>

#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "renderer/camera.h"
#include "renderer/cross_check.h"
#include "tests/support/device.h"

namespace twinray::path_tracer {

inline constexpr uint strategies[] = {STRATEGY_MIS, STRATEGY_LIGHTS, STRATEGY_BSDF};

inline bool same_bits(const HdrImage& a, const HdrImage& b) {
    return a.rgb.size() == b.rgb.size() && std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(vec3)) == 0;
}

struct RenderSetup {
    RenderSettings settings = {.width = 32, .height = 32, .samples = 64};
    std::unique_ptr<EnvironmentMap> environment = nullptr;  // null: black
    bool hardware = false;
};

inline Camera look(vec3 from, vec3 to, float half_height) {
    const vec3 backward = normalize(from - to);
    const vec3 helper = std::abs(backward.y) > 0.9f ? vec3(0, 0, 1) : vec3(0, 1, 0);
    const vec3 right = normalize(cross(helper, backward)), up = cross(backward, right);
    Camera camera;
    camera.camera_to_world = {{vec4(right.x, up.x, backward.x, from.x), vec4(right.y, up.y, backward.y, from.y),
                               vec4(right.z, up.z, backward.z, from.z)}};
    camera.vertical_fov = 2 * std::atan(half_height);
    return camera;
}

inline std::unique_ptr<EnvironmentMap> sky(float radiance) {
    return std::make_unique<EnvironmentMap>(constant_sky(vec3(radiance)));
}

inline std::unique_ptr<AbstractAccel> make_accel(Context& context, bool hardware) {
    if (hardware) return std::make_unique<HwTlas>(context);
    return std::make_unique<SwTlas>(context);
}

inline HdrImage render(Context& context, const Scene& scene, const RenderSetup& setup) {
    const LocalLights lights = collect_lights(scene);
    const DeviceScene device_scene(context, scene, lights, setup.environment.get());
    Renderer renderer(context, device_scene, setup.settings);
    const std::unique_ptr<AbstractAccel> accel = make_accel(context, setup.hardware);
    push_scene(*accel, scene);
    HdrImage picture = render_picture(renderer, setup.settings, *accel, true);
    EXPECT_EQ(renderer.stats().non_finite, 0u);
    return picture;
}

inline void add(Scene& scene, Mesh mesh, const Material& material, const Transform& transform = {}) {
    mesh.materials.assign(mesh.triangles.size(), static_cast<uint>(scene.materials.size()));
    scene.materials.push_back(material);
    scene.instances.push_back({mesh.name, static_cast<uint>(scene.meshes.size()), transform});
    scene.meshes.push_back(std::move(mesh));
}

// Makes a material that only has Lambert's term: an index of refraction of 1 reflects nothing.
inline Material lambert(float albedo) {
    return {.name = "lambert", .base_color = vec4(vec3(albedo), 1), .metallic = 0, .roughness = 1, .ior = 1};
}

inline Material lamp(float radiance) {
    return {.name = "lamp", .base_color = vec4(0, 0, 0, 1), .metallic = 0, .emission = vec3(radiance), .ior = 1};
}

// A floor, a square that looks down on its middle from 1 above it, and the factor by which that is seen from there.
inline Mesh wide_floor(float height = 0) { return make_quad({-5, height, -5}, {0, 0, 10}, {10, 0, 0}); }
inline Mesh square_above() { return make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}); }
inline constexpr double factor_of_square_above = 0.554126423979571987;

inline RenderSetup seen_from(vec3 from, vec3 to, float half_height) {
    RenderSetup setup;
    setup.settings.camera = camera_rays(look(from, to, half_height), 1);
    return setup;
}

// Returns a setup that looks at the middle of the floor from close by, under what is above it.
inline RenderSetup of_the_floor() {
    RenderSetup setup = seen_from({0, 0.5f, 0}, vec3(0), 1e-4f);
    setup.settings.max_depth = 1;
    return setup;
}

// The mean over pixels, which are independent of each other and have the same expectation.
struct Statistics {
    double mean = 0;
    double error = 0;  // standard deviation of the mean
};
inline Statistics statistics(const HdrImage& picture) {
    double sum = 0, squares = 0;
    for (const vec3& pixel : picture.rgb) sum += static_cast<double>(pixel.y);
    const auto n = static_cast<double>(picture.rgb.size());
    for (const vec3& pixel : picture.rgb) squares += std::pow(static_cast<double>(pixel.y) - sum / n, 2);
    return {sum / n, std::sqrt(squares / (n - 1) / n)};
}

// Expects this mean within four standard deviations, plus float rounding.
inline void expect_mean(const HdrImage& picture, double expected, const char* what) {
    const Statistics found = statistics(picture);
    EXPECT_NEAR(found.mean, expected, 4 * found.error + 2e-6 * expected) << what << ", error " << found.error;
}

inline const char* name_of_strategy(uint strategy) {
    return strategy == STRATEGY_MIS ? "both" : strategy == STRATEGY_LIGHTS ? "lights" : "surfaces";
}

inline void expect_mean_by_every_strategy(Context& context, const Scene& scene, RenderSetup setup, double expected) {
    for (const uint strategy : strategies) {
        setup.settings.strategy = strategy;
        expect_mean(render(context, scene, setup), expected, name_of_strategy(strategy));
    }
}

// Returns the mean that every strategy finds.
inline double same_mean_by_every_strategy(Context& context, const Scene& scene, RenderSetup setup) {
    Statistics found[3];
    for (const uint strategy : strategies) {
        setup.settings.strategy = strategy;
        found[strategy] = statistics(render(context, scene, setup));
        EXPECT_NEAR(found[strategy].mean, found[STRATEGY_MIS].mean,
                    4 * (found[strategy].error + found[STRATEGY_MIS].error))
            << name_of_strategy(strategy);
    }
    return found[STRATEGY_MIS].mean;
}

}  // namespace twinray::path_tracer
