// Layers and volumes of materials as kernels render them, and light through smooth walls without thickness, which
// shadow rays pass as well.
#include "tests/samples/bsdf_samples.h"
#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

class LayersRender : public test::VulkanTest {};

const vec3 to_camera = normalize(vec3(0, 0.8f, 0.6f)), to_light = normalize(vec3(-0.3f, 0.9f, -0.4f));

// Maps to a floor with its tangent along x.
vec3 local(vec3 w) { return {w.x, -w.z, w.y}; }

vec3 value_of(const Bsdf& bsdf) { return evaluate(bsdf, local(to_camera), local(to_light)).f; }

// Floors side by side in one picture, each with a material and its expected value: a kernel takes seconds to compile.
struct Floors {
    Scene scene = {};
    std::vector<const char*> names = {};
    std::vector<vec3> values = {};

    void add(const char* name, const Material& material, const Bsdf& bsdf) {
        Mesh floor = make_quad({4 * static_cast<float>(names.size()), 0, -5}, {0, 0, 10}, {4, 0, 0});
        floor.uvs.assign(4, vec2(0.5f));
        floor.tangents.assign(4, vec4(1, 0, 0, 1));
        path_tracer::add(scene, floor, material);
        names.push_back(name);
        values.push_back(value_of(bsdf));
    }
    // An image of one texel.
    std::int32_t texel(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a) {
        scene.images.push_back({"texel", 1, 1, {r, g, b, a}});
        return static_cast<std::int32_t>(scene.images.size()) - 1;
    }
};

// Expects the radiance of each floor under a directional light.
void expect_values(Context& context, Floors& floors) {
    floors.scene.lights = {
        {.name = "light", .kind = Light::Kind::directional, .color = vec3(1), .direction = -to_light}};
    const auto count = static_cast<uint>(floors.names.size());
    const vec3 middle(2 * static_cast<float>(count), 0, 0);
    Camera camera = look(middle + 9.0f * to_camera, middle, 1);
    camera.orthographic_half_height = 2;
    RenderSetup setup;
    setup.settings.width = count;
    setup.settings.height = setup.settings.samples = setup.settings.max_depth = 1;
    setup.settings.filter = FILTER_BOX;  // no pixel sees its neighbours' floors
    setup.settings.camera = camera_rays(camera, static_cast<float>(count));
    const HdrImage picture = render(context, floors.scene, setup);
    for (uint i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(picture.rgb[i][c], floors.values[i][c], 2e-3f * floors.values[i][c])
                << floors.names[i] << ' ' << c;
}

Material plastic_material() {
    return {.name = "plastic", .base_color = {0.8f, 0.4f, 0.2f, 1}, .metallic = 0, .roughness = 0.6f};
}
Bsdf plastic_bsdf() { return opaque_of({0.8f, 0.4f, 0.2f}, 0, 0.6f, 1.5f); }

TEST_F(LayersRender, FactorsReachTheBsdf) {
    Floors floors;
    floors.add("plain", plastic_material(), plastic_bsdf());

    Material material = plastic_material();
    material.specular = 0.5f;
    material.specular_color = {2, 8, 1};
    floors.add("specular", material, with_specular(plastic_bsdf(), vec3(0), 0, 1.5f, 0.5f, {2, 8, 1}));

    material = plastic_material();
    material.clearcoat = 0.75f;
    material.clearcoat_roughness = 0.5f;
    floors.add("coat", material, with_coat(plastic_bsdf(), 0.75f, 0.25f));

    material = plastic_material();
    material.sheen_color = {0.25f, 0.5f, 0.75f};
    material.sheen_roughness = 0.9f;
    floors.add("sheen", material, with_sheen(plastic_bsdf(), {0.25f, 0.5f, 0.75f}, 0.9f));

    for (const float turns : {0.0f, 0.125f, -0.25f}) {
        material = plastic_material();
        material.metallic = 1;
        material.roughness = 0.3f;
        material.anisotropy = 0.8f;
        material.anisotropy_rotation = turns * 2 * PI;
        const Bsdf metal = opaque_of({0.8f, 0.4f, 0.2f}, 1, 0.3f, 1.5f);
        floors.add("grain", material, with_grain(metal, mix(0.09f, 1.0f, 0.64f), turns));
    }
    expect_values(context(), floors);
}

// Only the channel that its extension names gives the right result; the other channels of each texture would not.
TEST_F(LayersRender, TexturesScaleTheirFactor) {
    Floors floors;
    const float half = 128 / 255.0f;
    const std::int32_t red = floors.texel(128, 9, 9, 9), green = floors.texel(9, 128, 9, 9),
                       alpha = floors.texel(9, 9, 9, 128), magenta = floors.texel(255, 0, 255, 9);
    Material material = plastic_material();
    material.specular_texture.image = alpha;
    material.specular_color_texture.image = magenta;
    floors.add("specular", material, with_specular(plastic_bsdf(), vec3(0), 0, 1.5f, half, {1, 0, 1}));

    material = plastic_material();
    material.clearcoat = material.clearcoat_roughness = 1;
    material.clearcoat_texture.image = red;
    material.clearcoat_roughness_texture.image = green;
    floors.add("coat", material, with_coat(plastic_bsdf(), half, half * half));

    // The normal is about (0.6, 0, 0.8) by tangent, bitangent and normal.
    material.clearcoat_normal_texture.image = floors.texel(204, 128, 230, 9);
    const vec3 normal = normalize(vec3(204 / 127.5f - 1, 128 / 127.5f - 1, 230 / 127.5f - 1));
    floors.add("normal of a coat", material, with_coat(plastic_bsdf(), half, half * half, normal));

    material = plastic_material();
    material.sheen_color = vec3(1);
    material.sheen_roughness = 1;
    material.sheen_color_texture.image = magenta;
    material.sheen_roughness_texture.image = alpha;
    floors.add("sheen", material, with_sheen(plastic_bsdf(), {1, 0, 1}, half));

    material = plastic_material();
    material.anisotropy = 1;
    material.anisotropy_texture.image = floors.texel(255, 191, 128, 9);
    Bsdf bsdf = with_grain(plastic_bsdf(), mix(0.36f, 1.0f, half * half), 0);
    bsdf.grain = normalize(vec2(255 / 127.5f - 1, 191 / 127.5f - 1));
    floors.add("grain", material, bsdf);
    expect_values(context(), floors);
}

// Makes a box of a volume without an interface, between the camera and what shines.
Scene box_of(const Material& amber) {
    Scene scene;
    Mesh box = make_box({-1, -1, -1}, {1, 1, 1});
    box.normals.clear();
    add(scene, box, amber);
    return scene;
}

Material amber(vec3 color, float distance) {
    return {.name = "amber",
            .metallic = 0,
            .roughness = 0,
            .transmission = 1,
            .ior = 1,
            .thickness = 1,
            .attenuation_color = color,
            .attenuation_distance = distance};
}

RenderSetup through_the_box() {
    RenderSetup setup = seen_from({0.1f, 0.2f, 5}, {0.1f, 0.2f, 0}, 1e-4f);
    setup.settings.samples = setup.settings.width = setup.settings.height = 1;
    return setup;
}

TEST_F(LayersRender, AVolumeDimsByTheLengthOfTheWay) {
    RenderSetup setup = through_the_box();
    setup.environment = sky(1);
    const vec3 seen = render(context(), box_of(amber({0.5f, 0.25f, 1}, 4)), setup).rgb[0];
    EXPECT_NEAR(seen.x, std::sqrt(0.5f), 1e-4f);
    EXPECT_NEAR(seen.y, 0.5f, 1e-4f);
    EXPECT_NEAR(seen.z, 1, 1e-6f);
    EXPECT_EQ(render(context(), box_of(amber(vec3(0), 1)), setup).rgb[0], vec3(0));
}

TEST_F(LayersRender, WhatLiesInsideAVolumeIsDimmedByTheWayToIt) {
    Scene scene = box_of(amber(vec3(0.5f), 1));
    add(scene, make_quad({-0.9f, -0.9f, 0.5f}, {1.8f, 0, 0}, {0, 1.8f, 0}), lamp(8));
    EXPECT_NEAR(render(context(), scene, through_the_box()).rgb[0].x, 8 * std::sqrt(0.5f), 1e-3f);
    // A blended surface on the way is passed without counting the way twice.
    Material veil = lambert(0);
    veil.base_color.w = 0;
    veil.alpha_mode = AlphaMode::blend;
    add(scene, make_quad({-0.9f, -0.9f, 0.75f}, {1.8f, 0, 0}, {0, 1.8f, 0}), veil);
    EXPECT_NEAR(render(context(), scene, through_the_box()).rgb[0].x, 8 * std::sqrt(0.5f), 1e-3f);
}

// A pane bends nothing, a block of the same surface does: both show the sky tinted, the pane what lies straight behind.
TEST_F(LayersRender, WithoutAThicknessGlassIsAPane) {
    Scene scene;
    Material pane{.name = "pane", .base_color = {0.5f, 1, 0.25f, 1}, .metallic = 0, .roughness = 0, .transmission = 1};
    add(scene, wide_floor(1), pane);
    add(scene, make_quad({-0.01f, 0, -0.01f}, {0, 0, 0.02f}, {0.02f, 0, 0}), lamp(1));
    RenderSetup setup = seen_from({2, 2, 0}, vec3(0), 1e-4f);
    setup.settings.width = setup.settings.height = 8;
    setup.settings.samples = 256;
    const double kept = 1 - static_cast<double>(fresnel_dielectric(std::sqrt(0.5f), 1.5f));
    const HdrImage seen = render(context(), scene, setup);
    expect_mean(seen, kept, "pane");
    EXPECT_NEAR(seen.rgb[0].x, 0.5f * seen.rgb[0].y, 1e-5f);
    scene.materials[0].thickness = 1;
    EXPECT_EQ(statistics(render(context(), scene, setup)).mean, 0) << "bent aside";
}

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
    Light spot = bulb;
    spot.name = "spot", spot.kind = Light::Kind::spot, spot.direction = way;
    spot.inner_cone = 0.1f, spot.outer_cone = 0.2f;
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
        RenderSetup setup = of_the_floor();
        if (has_sky) setup.environment = sky(1);
        SCOPED_TRACE(has_sky);
        const double found = same_mean_by_every_strategy(context(), scene, std::move(setup));
        EXPECT_GT(found, has_sky ? 0.4 : 0.07);
        EXPECT_LT(found, has_sky ? 0.46 : 0.12);
    }
}

// A white ball is within spheres that take nothing away, under a white sky: all is as bright as the sky.
TEST_F(Panes, AWhiteFurnaceWithPanesStaysWhite) {
    Scene scene;
    add(scene, make_icosphere(2), lambert(1), Transform::scaling(vec3(0.5f)));
    for (const float radius : {0.75f, 1.0f}) add(scene, make_icosphere(2), pane(), Transform::scaling(vec3(radius)));
    for (Mesh& mesh : scene.meshes) mesh.normals.clear();
    RenderSetup setup = seen_from({0, 0, 4}, vec3(0), 0.3f);
    setup.environment = sky(1);
    setup.settings.samples = 16;
    setup.settings.max_depth = 100;
    expect_mean_by_every_strategy(context(), scene, std::move(setup), 1);
}

// Like shadow rays, paths pass panes without counting them as scatterings.
TEST_F(Panes, PathsSeeThroughPanesAtAnyDepth) {
    Scene scene = floor_below(std::vector<Material>(40, pane()));
    scene.materials[0] = lamp(1);
    RenderSetup setup = seen_from({0, 20, 0}, vec3(0), 1e-4f);
    setup.settings.samples = 256;
    setup.settings.max_depth = 0;
    expect_mean(render(context(), scene, setup), std::pow(passed(1), 40), "40 panes");
}

}  // namespace
}  // namespace twinray::path_tracer
