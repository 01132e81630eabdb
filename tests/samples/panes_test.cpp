// SPDX-License-Identifier: MIT
// Light through smooth walls without thickness, which shadow rays pass as well.
#include "tests/samples/bsdf_samples.h"
#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

class Panes : public test::VulkanTest {};

Material pane(vec3 color = vec3(1)) {
    return {.name = "pane", .base_color = vec4(color, 1), .metallic = 0, .roughness = 0, .transmission = 1};
}

Mesh level(float height) { return make_quad({-50, height, -50}, {0, 0, 100}, {100, 0, 0}); }

// Returns a white floor below panes.
Scene floor_below(const std::vector<Material>& panes) {
    Scene scene;
    add(scene, level(0), lambert(1));
    for (std::size_t i = 0; i < panes.size(); ++i) add(scene, level(1 + 0.25f * static_cast<float>(i)), panes[i]);
    return scene;
}

double passed(double cosine) { return 1 - static_cast<double>(fresnel_dielectric(static_cast<float>(cosine), 1.5f)); }

std::vector<Light> lights_at(double cosine) {
    const vec3 way(-static_cast<float>(std::sqrt(1 - cosine * cosine)), -static_cast<float>(cosine), 0);
    const vec3 color(PI / static_cast<float>(cosine));
    const Light sun{.name = "sun", .kind = Light::Kind::directional, .color = color, .direction = way};
    const Light bulb{.name = "bulb", .kind = Light::Kind::point, .color = 64.0f * color, .position = -8.0f * way};
    const Light spot{.name = "spot",
                     .kind = Light::Kind::spot,
                     .color = 64.0f * color,
                     .position = -8.0f * way,
                     .direction = way,
                     .inner_cone = 0.1f,
                     .outer_cone = 0.2f};
    return {sun, bulb, spot};
}

// Returns the radiance of a floor under a light that gives it 1 without panes.
vec3 lit_through(Context& context, const std::vector<Material>& panes, const Light& light) {
    Scene scene = floor_below(panes);
    scene.lights = {light};
    RenderSetup setup = of_the_floor();
    setup.settings.width = setup.settings.height = 1;
    setup.settings.samples = 1;
    return render(context, scene, setup).rgb[0];
}

TEST_F(Panes, LightsWithoutSizeShineThroughDimmedAsTheCameraSeesThem) {
    const vec3 tint(1, 0.5f, 0.25f);
    constexpr double cosine = 0.25;
    for (const Light& light : lights_at(cosine)) {
        const vec3 one = lit_through(context(), {pane(tint)}, light);
        const vec3 two = lit_through(context(), {pane(tint), pane()}, light);
        for (int c = 0; c < 3; ++c) {
            const double dimmed = static_cast<double>(tint[c]) * passed(cosine);
            EXPECT_NEAR(one[c], dimmed, 1e-3) << light.name;
            EXPECT_NEAR(two[c], dimmed * passed(cosine), 1e-3) << light.name;
        }
    }
}

TEST_F(Panes, WhatIsPassedInPartDimsByThatPart) {
    const Light sun = lights_at(1)[0];
    Material half = pane(vec3(0.5f));
    half.transmission = 0.5f;
    EXPECT_NEAR(lit_through(context(), {half}, sun).x, 0.25 * passed(1), 1e-4);
    half.metallic = 0.5f;
    EXPECT_NEAR(lit_through(context(), {half}, sun).x, 0.125 * passed(1), 1e-4);
    Material veil = pane(vec3(0.5f));
    veil.base_color.w = 0.25f;
    veil.alpha_mode = AlphaMode::blend;
    EXPECT_NEAR(lit_through(context(), {veil}, sun).x, 0.75 + 0.125 * passed(1), 1e-4);
    Material coated = pane();
    coated.clearcoat = 0.5f;
    EXPECT_NEAR(lit_through(context(), {coated}, sun).x, 0.98 * passed(1), 1e-4);
}

TEST_F(Panes, RoughWallsAndVolumesStopLightsWithoutSize) {
    Material rough = pane(), thick = pane(), metal = pane();
    rough.roughness = 0.2f, thick.thickness = 1, metal.metallic = 1;
    for (const Material& material : {rough, thick, metal})
        EXPECT_EQ(lit_through(context(), {pane(), material}, lights_at(1)[0]), vec3(0)) << material.thickness;
}

// Light sampling, surfaces, and both find the same light: nothing is counted twice or lost.
TEST_F(Panes, LightsWithSizeAreFoundOnceByEveryStrategy) {
    for (const bool has_sky : {false, true}) {
        Scene scene = floor_below({pane(vec3(0.5f)), pane()});
        if (!has_sky) add(scene, make_quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), lamp(1));
        Statistics found[3];
        for (const uint strategy : strategies) {
            RenderSetup setup = of_the_floor();
            if (has_sky) setup.environment = sky(1);
            setup.settings.strategy = strategy;
            found[strategy] = statistics(render(context(), scene, setup));
        }
        for (const uint strategy : {STRATEGY_LIGHTS, STRATEGY_BSDF})
            EXPECT_NEAR(found[strategy].mean, found[STRATEGY_MIS].mean,
                        4 * (found[strategy].error + found[STRATEGY_MIS].error))
                << has_sky << ' ' << strategy;
        EXPECT_GT(found[STRATEGY_MIS].mean, has_sky ? 0.4 : 0.07);
        EXPECT_LT(found[STRATEGY_MIS].mean, has_sky ? 0.46 : 0.12);
    }
}

// A white ball is within spheres that take nothing away, under a white sky: all is as bright as the sky.
TEST_F(Panes, AWhiteFurnaceWithPanesStaysWhite) {
    Scene scene;
    add(scene, make_icosphere(2), lambert(1), Transform::scaling(vec3(0.5f)));
    for (const float radius : {0.75f, 1.0f}) add(scene, make_icosphere(2), pane(), Transform::scaling(vec3(radius)));
    for (Mesh& mesh : scene.meshes) mesh.normals.clear();
    for (const uint strategy : strategies) {
        RenderSetup setup;
        setup.environment = sky(1);
        setup.settings.samples = 16;
        setup.settings.max_depth = 100;
        setup.settings.strategy = strategy;
        setup.settings.camera = camera_rays(look({0, 0, 4}, vec3(0), 0.3f), 1);
        expect_mean(render(context(), scene, setup), 1, "white furnace");
    }
}

// Like shadow rays, paths pass panes without counting them as scatterings.
TEST_F(Panes, PathsSeeThroughPanesAtAnyDepth) {
    Scene scene = floor_below(std::vector<Material>(40, pane()));
    scene.materials[0] = lamp(1);
    RenderSetup setup;
    setup.settings.samples = 256;
    setup.settings.max_depth = 0;
    setup.settings.camera = camera_rays(look({0, 20, 0}, vec3(0), 1e-4f), 1);
    expect_mean(render(context(), scene, setup), std::pow(passed(1), 40), "40 panes");
}

}  // namespace
}  // namespace twinray::path_tracer
