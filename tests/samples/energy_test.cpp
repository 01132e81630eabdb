// Pictures with a known value, and beside those of Mitsuba 3 of the same triangles and materials
// (bench/peers/renderers.py).
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/reference.h"
#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

class Energy : public test::VulkanTest {};

Mesh flat_sphere(uint subdivisions) {
    Mesh mesh = make_icosphere(subdivisions);
    mesh.normals.clear();
    return mesh;
}

TEST_F(Energy, AWhiteConvexObjectVanishesInAWhiteFurnace) {
    Scene scene;
    add(scene, flat_sphere(2), lambert(1));
    RenderSetup setup = seen_from({0, 0, 4}, vec3(0), 0.2f);
    setup.environment = sky(1);
    expect_mean_by_every_strategy(context(), scene, std::move(setup), 1);
}

Scene closed_furnace(float albedo) {
    Scene scene;
    Material wall = lambert(albedo);
    wall.emission = vec3(1);
    wall.double_sided = true;
    add(scene, flat_sphere(2), wall);
    return scene;
}

TEST_F(Energy, InsideAClosedFurnaceRadianceIsTheSumOfAllBounces) {
    RenderSetup setup = seen_from({0.1f, 0, 0}, {1, 0.2f, 0.3f}, 0.5f);
    setup.settings.max_depth = 12;
    for (const float albedo : {0.5f, 0.9f}) {
        double expected = 0;
        for (int bounce = 12; bounce >= 0; --bounce) expected = 1 + static_cast<double>(albedo) * expected;
        expect_mean(render(context(), closed_furnace(albedo), setup), expected, "closed furnace");
    }
}

// Paths have 100 bounces on average, and roulette must spare enough of them: survivors that weigh ever more would leave
// 20 % out.
TEST_F(Energy, DeepPathsArriveWithTheirShare) {
    RenderSetup setup = seen_from({0.1f, 0, 0}, {1, 0.2f, 0.3f}, 0.5f);
    setup.settings.samples = 2;
    setup.settings.max_depth = 2000;
    setup.settings.strategy = STRATEGY_BSDF;
    const HdrImage picture = render(context(), closed_furnace(0.99f), setup);
    expect_mean(picture, 100, "albedo 0.99");
    EXPECT_LT(statistics(picture).error, 100.0 * 1.2 / std::sqrt(2.0 * 32 * 32))
        << "lengths vary as a geometric distribution";
}

// Rounding moves a shadow ray by more than the precision of the light's points.
TEST_F(Energy, ALightSmallForItsDistanceDoesNotHideItself) {
    Scene scene;
    add(scene, wide_floor(-1), lambert(1));
    add(scene, make_quad({-5e-5f, 0, -5e-5f}, {1e-4f, 0, 0}, {0, 0, 1e-4f}), lamp(1e8f * PI));
    RenderSetup setup = seen_from({0, -0.5f, 0}, {0, -1, 0}, 1e-4f);
    setup.settings.max_depth = 1;
    for (const bool hardware : {false, true}) {
        if (hardware && !missing_for_hardware(context().properties()).empty()) continue;
        setup.hardware = hardware;
        EXPECT_NEAR(statistics(render(context(), scene, setup)).mean, 1, 1e-6);
    }
}

// A 2 x 2 light is 1 above the middle of a floor: view factor 0.554126.
TEST_F(Energy, ARectangularLightGivesItsAnalyticIrradianceByEveryStrategy) {
    Scene scene;
    add(scene, wide_floor(), lambert(1));
    add(scene, square_above(), lamp(1));
    expect_mean_by_every_strategy(context(), scene, of_the_floor(), factor_of_square_above);
}

// The same lamp has a sky and a point light beside it: each is chosen with its share.
TEST_F(Energy, AnEnvironmentALampAndAPointLightAddUpByEveryStrategy) {
    const double view_factor = factor_of_square_above;
    Scene scene;
    add(scene, wide_floor(), lambert(1));
    add(scene, square_above(), lamp(2));
    scene.lights = {{.name = "light", .kind = Light::Kind::point, .color = vec3(0.5f), .position = {0, 0.5f, 0}}};
    RenderSetup setup = of_the_floor();
    setup.environment = sky(0.5f);
    for (const uint strategy : strategies) {
        setup.settings.strategy = strategy;
        const double by_point = strategy == STRATEGY_BSDF ? 0 : 0.5 / 0.25 / static_cast<double>(PI);
        expect_mean(render(context(), scene, setup), 2 * view_factor + 0.5 * (1 - view_factor) + by_point,
                    name_of_strategy(strategy));
    }
}

// There are points above a floor and, a thousand times as strong, below it; spots, some of which look away; a sun.
TEST_F(Energy, ManyLampsAddUp) {
    Scene scene;
    add(scene, wide_floor(), lambert(1));
    double expected = 0;
    for (int i = 0; i < 200; ++i) {
        const float x = 0.25f * static_cast<float>(i % 20 - 10), z = 0.5f * static_cast<float>(i / 20 - 5);
        const vec3 at(x, i % 3 == 0 ? -1.0f : 1 + 0.1f * static_cast<float>(i % 7), z);
        const bool is_spot = i % 5 == 0, looks_away = i % 2 == 0;
        const float power = at.y < 0 ? 1000 : 1;
        scene.lights.push_back({.name = "light",
                                .kind = is_spot ? Light::Kind::spot : Light::Kind::point,
                                .color = vec3(power),
                                .position = at,
                                .direction = is_spot && looks_away ? normalize(at) : normalize(-at),
                                .inner_cone = 0.3f,
                                .outer_cone = 0.5f});
        if (at.y > 0 && !(is_spot && looks_away))
            expected += static_cast<double>(at.y) / std::pow(static_cast<double>(length(at)), 3);
    }
    scene.lights.push_back(
        {.name = "sun", .kind = Light::Kind::directional, .color = vec3(20), .direction = {0, -1, 0}});
    expected += 20;
    const HdrImage picture = render(context(), scene, of_the_floor());
    expect_mean(picture, expected / static_cast<double>(PI), "200 lamps and a sun");
    EXPECT_LT(statistics(picture).error * 32, 0.1 * expected / static_cast<double>(PI)) << "of a pixel of 64 paths";
}

// The front of a mirrored lamp is the same side of its surface.
TEST_F(Energy, MirroredLampsShineFromTheSameSideByEveryStrategy) {
    for (const bool faces_down : {false, true}) {
        Scene scene;
        add(scene, wide_floor(), lambert(1));
        add(scene, faces_down ? square_above() : make_quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}), lamp(1),
            Transform::scaling({-1, 1, 1}));
        expect_mean_by_every_strategy(context(), scene, of_the_floor(), faces_down ? factor_of_square_above : 0);
    }
}

TEST_F(Energy, ALightShinesFromItsFrontOnlyUnlessItIsTwoSided) {
    for (const bool is_two_sided : {false, true}) {
        Material light = lamp(1);
        light.double_sided = is_two_sided;
        Scene scene;
        add(scene, wide_floor(), lambert(1));
        add(scene, make_quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}), light);  // faces up
        expect_mean(render(context(), scene, of_the_floor()), is_two_sided ? factor_of_square_above : 0, "two-sided");
    }
}

TEST_F(Energy, AnUnevenEnvironmentGivesTheSameByEveryStrategy) {
    Scene scene;
    add(scene, wide_floor(), lambert(0.8f));
    HdrImage image{16, 8, std::vector<vec3>(128, vec3(0.1f))};
    image.rgb[2 * 16 + 5] = vec3(40);
    image.rgb[1 * 16 + 12] = vec3(7);
    RenderSetup setup = of_the_floor();
    setup.environment = std::make_unique<EnvironmentMap>(image);
    EXPECT_GT(same_mean_by_every_strategy(context(), scene, std::move(setup)), 0.1);
}

TEST_F(Energy, PunctualLightsGiveTheirAnalyticIrradiance) {
    const Light sun{
        .name = "light", .kind = Light::Kind::directional, .color = vec3(3), .direction = normalize(vec3(0, -1, 1))};
    const Light point{.name = "light", .kind = Light::Kind::point, .color = vec3(5), .position = {0, 2, 0}};
    Light faded = point, spot = point;
    faded.range = 4;
    spot.kind = Light::Kind::spot;
    Light aside = spot;
    spot.direction = {0, -1, 0};
    aside.direction = {1, 0, 0};
    const double pi = static_cast<double>(PI);
    const struct {
        Light light;
        double irradiance;
    } cases[] = {{sun, 3 * std::sqrt(0.5)}, {point, 1.25}, {faded, 1.25 * (1 - 1.0 / 16)}, {spot, 1.25}, {aside, 0}};
    for (const auto& c : cases) {
        Scene scene;
        add(scene, wide_floor(), lambert(1));
        scene.lights = {c.light};
        expect_mean(render(context(), scene, of_the_floor()), c.irradiance / pi, "punctual");
    }
}

TEST_F(Energy, AGlassSphereVanishesInAWhiteFurnace) {
    for (const float roughness : {0.0f, 0.4f}) {
        Scene scene;
        Material glass{
            .name = "glass", .metallic = 0, .roughness = roughness, .transmission = 1, .ior = 1.5f, .thickness = 1};
        add(scene, make_icosphere(4), glass);
        RenderSetup setup = seen_from({0, 0, 4}, vec3(0), 0.15f);
        setup.environment = sky(1);
        setup.settings.max_depth = 200;
        const HdrImage picture = render(context(), scene, setup);
        if (roughness == 0) expect_mean(picture, 1, "smooth glass");
        // A rough interface scatters once and loses what would scatter again.
        else
            EXPECT_NEAR(statistics(picture).mean, 0.95, 0.05);
    }
}

TEST_F(Energy, AWhiteRoughMirrorReflectsItsSingleScatteringAlbedo) {
    Scene scene;
    add(scene, wide_floor(), {.name = "metal", .metallic = 1, .roughness = std::sqrt(0.5f)});
    RenderSetup setup = seen_from({0, 1, 0}, vec3(0), 1e-3f);
    setup.environment = sky(1);
    expect_mean(render(context(), scene, setup), 0.68785, "alpha 0.5, seen from above");
}

TEST_F(Energy, DepthZeroShowsOnlyWhatEmits) {
    Scene scene;
    add(scene, make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), lambert(1));
    add(scene, make_quad({-1, 5, -1}, {2, 0, 0}, {0, 0, 2}), lamp(1));
    for (const auto& [to, mean] : {std::pair{vec3(0), 0}, std::pair{vec3(0, 5, 0), 1}}) {
        RenderSetup setup = seen_from({0, 3, 0}, to, 0.1f);
        setup.settings.max_depth = 0;
        EXPECT_EQ(statistics(render(context(), scene, setup)).mean, mean);
    }
}

TEST_F(Energy, PicturesScaleExactlyWithPowersOfTwoOfTheLight) {
    HdrImage pictures[2];
    for (const int power : {0, 1}) {
        Scene scene = cornell_box_scene();
        for (Material& material : scene.materials) material.emission *= power ? 0x1p20f : 1.0f;
        RenderSetup setup;
        setup.settings.samples = 2;
        setup.settings.camera = camera_rays(scene.cameras[0], 1);
        pictures[power] = render(context(), scene, setup);
    }
    for (std::size_t i = 0; i < pictures[0].rgb.size(); ++i)
        EXPECT_EQ(pictures[0].rgb[i] * 0x1p20f, pictures[1].rgb[i]);
}

class PeersTest : public test::VulkanTest {};

// The means over blocks of pixels, by channel, and their standard errors.
struct Blocks {
    std::vector<double> mean, error;
};

struct Reference {
    Blocks blocks;
    uint side, block, depth;
    std::unique_ptr<EnvironmentMap> sky;
};

Reference load_reference(const std::string& name) {
    std::ifstream in(std::string(TWINRAY_PEERS_FOLDER "/") + name + ".json");
    const nlohmann::json json = nlohmann::json::parse(in);
    Reference reference{{json["mean"], json["error"]}, json["side"], json["block"], json["depth"], nullptr};
    if (!json.contains("sky")) return reference;
    HdrImage image;
    const std::vector<float> sky = json["sky"];
    image.width = json["sky_width"];
    image.height = static_cast<uint>(sky.size() / 3 / image.width);
    for (std::size_t i = 0; i < sky.size(); i += 3) image.rgb.push_back({sky[i], sky[i + 1], sky[i + 2]});
    reference.sky = std::make_unique<EnvironmentMap>(std::move(image));
    return reference;
}

// Renders with different seeds.
Blocks rendered_blocks(Context& context, const Scene& scene, Reference& reference, uint runs) {
    std::vector<double> sums(reference.blocks.mean.size()), squares(sums.size());
    RenderSetup setup;
    setup.settings = {.width = reference.side,
                      .height = reference.side,
                      .samples = 16,
                      .max_depth = reference.depth,
                      .camera = camera_rays(scene.cameras[0], 1),
                      .filter = FILTER_BOX};
    setup.environment = std::move(reference.sky);
    for (setup.settings.seed = 1; setup.settings.seed <= runs; ++setup.settings.seed) {
        const std::vector<double> means = block_means(render(context, scene, setup), reference.block);
        for (std::size_t i = 0; i < sums.size(); ++i) {
            sums[i] += means[i];
            squares[i] += means[i] * means[i];
        }
    }
    Blocks blocks;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double mean = sums[i] / runs;
        blocks.mean.push_back(mean);
        blocks.error.push_back(std::sqrt(std::max(squares[i] / runs - mean * mean, 0.0) / (runs - 1)));
    }
    return blocks;
}

void expect_alike(Context& context, const std::string& name) {
    const Scene scene = load_scene(std::string(TWINRAY_PEERS_FOLDER "/") + name + ".gltf");
    Reference reference = load_reference(name);
    const Blocks blocks = rendered_blocks(context, scene, reference, 16);
    double sum = 0, squares = 0, largest = 0;
    for (std::size_t i = 0; i < blocks.mean.size(); ++i) {
        const double z =
            (blocks.mean[i] - reference.blocks.mean[i]) / std::hypot(blocks.error[i], reference.blocks.error[i]);
        sum += z;
        squares += z * z;
        largest = std::max(largest, std::abs(z));
    }
    const auto count = static_cast<double>(blocks.mean.size());
    // The channels of a block go together, so there are a third as many independent scores; those of 16 runs have a
    // variance of 15 / 13.
    EXPECT_LT(std::abs(sum / count), 4 / std::sqrt(count / 3));
    EXPECT_LT(squares / count, 15.0 / 13 + 4 * std::sqrt(2 / (count / 3)));
    EXPECT_GT(squares / count, 1 - 4 * std::sqrt(2 / (count / 3)));
    EXPECT_LT(largest, 6);
    testing::Test::RecordProperty("rms_z", std::to_string(std::sqrt(squares / count)));
}

TEST_F(PeersTest, MitsubasCornellBoxLooksAsByMitsuba) { expect_alike(context(), "cornell_box"); }
TEST_F(PeersTest, MetalAndGlassLookAsByMitsuba) { expect_alike(context(), "metal_and_glass"); }
TEST_F(PeersTest, TexturesUnderASkyLookAsByMitsuba) { expect_alike(context(), "textured_sky"); }

}  // namespace
}  // namespace twinray::path_tracer
