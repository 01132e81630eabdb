// Pictures, what they must and must not depend on, and the films behind them.
#include <cstring>

#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

class PathTracer : public test::VulkanTest {};

RenderSetup cornell_shot(const Scene& scene) {
    RenderSetup setup;
    setup.settings.samples = 4;
    setup.settings.camera = camera_rays(scene.cameras[0], 1);
    return setup;
}

TEST_F(PathTracer, TheSameSeedGivesTheSameBitsAndAnotherDoesNot) {
    const Scene scene = cornell_box_scene();
    RenderSetup setup = cornell_shot(scene);
    const HdrImage first = render(context(), scene, setup);
    EXPECT_TRUE(same_bits(first, render(context(), scene, setup)));
    setup.settings.seed = 2;
    EXPECT_FALSE(same_bits(first, render(context(), scene, setup)));
}

TEST_F(PathTracer, EveryDifferenceBetweenTheAcceleratorsComesFromARayOnWhichTheyDisagree) {
    if (!missing_for_hardware(context().properties()).empty())
        TWINRAY_LACKS("ray_tracing", "no ray tracing extensions");
    Scene scene = cornell_box_scene();
    // Blended and masked surfaces too, so that rays pass surfaces.
    scene.materials[1].base_color.w = 0.5f;
    scene.materials[1].alpha_mode = AlphaMode::blend;
    HwTlas hardware(context());
    SwTlas software(context());
    push_scene(hardware, scene);
    push_scene(software, scene);
    software.sync();
    const DeviceScene device_scene(context(), scene, collect_lights(scene), nullptr);
    RenderSettings settings = cornell_shot(scene).settings;
    settings.width = settings.height = 64;
    Renderer renderer(context(), device_scene, settings);
    CrossChecker checker(context(), software, renderer, 64 * 64);
    const HdrImage by_hardware = render_picture(renderer, settings, hardware, true, &checker);
    const HdrImage by_software = render_picture(renderer, settings, software, true);
    const PictureDifference difference = compare_pictures(by_hardware, by_software, checker.marks());
    EXPECT_EQ(difference.unexplained, 0u);
    EXPECT_LT(checker.found(), 10u);
    EXPECT_EQ(checker.recorded().size(), checker.found());
}

// Materials that transmit next to nothing are of the kind of glass, but look as they did.
TEST_F(PathTracer, ShadingByKindOfMaterialChangesNoBit) {
    Scene scene = cornell_box_scene();
    RenderSetup setup = cornell_shot(scene);
    setup.environment = sky(0.5f);
    ASSERT_GT(kinds_of(scene).needs.size(), 1u);
    const HdrImage queued = render(context(), scene, setup);
    for (Material& material : scene.materials) {
        material.transmission = std::max(material.transmission, 1e-30f);
        material.thickness = 1;
    }
    ASSERT_EQ(kinds_of(scene).needs.size(), 1u);
    EXPECT_TRUE(same_bits(queued, render(context(), scene, setup)));
}

// The check must be able to fail: it finds the wall that another scene lacks.
TEST_F(PathTracer, TheCrossCheckFindsAMissingWall) {
    Scene scene = cornell_box_scene();
    SwTlas whole(context()), broken(context());
    push_scene(whole, scene);
    scene.meshes[2].positions[0] += vec3(0, 0.7f, 0);
    push_scene(broken, scene);
    broken.sync();
    const DeviceScene device_scene(context(), scene, collect_lights(scene), nullptr);
    const RenderSettings settings = cornell_shot(scene).settings;
    Renderer renderer(context(), device_scene, settings);
    CrossChecker checker(context(), broken, renderer, 32 * 32);
    const HdrImage right = render_picture(renderer, settings, whole, true, &checker);
    EXPECT_GT(checker.found(), 100u);
    const std::vector<uint> nothing_marked(32 * 32);
    EXPECT_GT(compare_pictures(right, render_picture(renderer, settings, broken, true), nothing_marked).unexplained,
              0u);
}

TEST_F(PathTracer, AMaskedSurfaceLetsLightThroughWhereItsTextureIsClear) {
    Scene scene;
    add(scene, wide_floor(), lambert(1));
    add(scene, square_above(), lamp(1));
    RenderSetup setup = of_the_floor();
    const HdrImage open = render(context(), scene, setup);
    scene.images.push_back({"clear", 2, 2, std::vector<std::uint8_t>(16, 100)});
    Material screen = lambert(1);
    screen.base_color_texture.image = 0;
    screen.alpha_mode = AlphaMode::mask;
    add(scene, wide_floor(0.75f), screen);
    EXPECT_TRUE(same_bits(open, render(context(), scene, setup))) << "clear, in the way of shadow rays";
    add(scene, wide_floor(0.25f), screen);
    expect_mean(render(context(), scene, setup), factor_of_square_above, "clear, in the way of camera rays too");
    scene.materials[2].alpha_cutoff = 0.2f;
    EXPECT_EQ(statistics(render(context(), scene, setup)).mean, 0) << "opaque";
}

// Makes a floor that a sun above gives a radiance of 1.
Scene sunlit_floor() {
    Scene scene;
    add(scene, wide_floor(), lambert(1));
    scene.lights = {{.name = "light", .kind = Light::Kind::directional, .color = vec3(PI), .direction = {0, -1, 0}}};
    return scene;
}

TEST_F(PathTracer, ABlendedSurfaceDimsLightByItsAlpha) {
    Scene scene = sunlit_floor();
    Material screen = lambert(0);
    screen.base_color.w = 0.25f;
    screen.alpha_mode = AlphaMode::blend;
    for (int i = 0; i < 3; ++i) add(scene, wide_floor(1 + static_cast<float>(i)), screen);
    expect_mean(render(context(), scene, of_the_floor()), 0.75 * 0.75 * 0.75, "three screens before the light");
    RenderSetup setup = seen_from({0, 9, 0}, vec3(0), 1e-4f);
    setup.settings.max_depth = 1;
    setup.settings.samples = 256;
    expect_mean(render(context(), scene, setup), std::pow(0.75, 6), "and before the camera");
}

// Like leaves, hair and fences: 100 sheets of one material are before the light, and the camera.
TEST_F(PathTracer, AnyNumberOfTransparentSurfacesIsPassed) {
    for (const float alpha : {0.0f, 0.02f})
        for (const AlphaMode mode : {AlphaMode::blend, AlphaMode::mask}) {
            Scene scene = sunlit_floor();
            Material screen = lambert(0);
            screen.base_color.w = alpha;
            screen.alpha_mode = mode;
            add(scene, wide_floor(1), screen);
            for (int i = 1; i < 100; ++i)
                scene.instances.push_back({"sheet", 1, Transform::translation({0, 0.01f * static_cast<float>(i), 0})});
            const double passed = mode == AlphaMode::blend ? std::pow(1 - static_cast<double>(alpha), 100) : 1;
            RenderSetup setup = of_the_floor();
            setup.settings.samples = 1;
            EXPECT_NEAR(statistics(render(context(), scene, setup)).mean, passed, 1e-4) << "before the light";
            setup.settings.camera = camera_rays(look({0, 9, 0}, vec3(0), 1e-4f), 1);
            setup.settings.samples = 2;
            expect_mean(render(context(), scene, setup), passed * passed, "and before the camera");
        }
}

TEST_F(PathTracer, TiltedShadingNormalsLetNoLightThrough) {
    Scene scene;
    Mesh floor = wide_floor();
    floor.normals.assign(4, normalize(vec3(1, 0.05f, 0)));
    add(scene, floor, {.name = "plastic", .metallic = 0, .roughness = 0.5f});
    // The light comes from below the floor, but above the tilted shading horizon.
    scene.lights = {{.name = "light", .kind = Light::Kind::directional, .direction = normalize(vec3(-1, 0.02f, 0))}};
    const RenderSetup setup = seen_from({1, 0.5f, 0}, vec3(0), 0.1f);
    EXPECT_EQ(statistics(render(context(), scene, setup)).mean, 0);
    scene.lights[0].direction = normalize(vec3(-1, -0.02f, 0));
    EXPECT_GT(statistics(render(context(), scene, setup)).mean, 0);
}

TEST_F(PathTracer, TexturesAreSampledWithTheirTransformAndWrapping) {
    // Row 0: red, green. Row 1: blue, white.
    Scene scene;
    scene.images.push_back({"four", 2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}});
    const auto color_at = [&](vec2 uv, Texture texture) {
        Mesh quad = make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
        quad.uvs.assign(4, uv);
        Material material{.name = "picture", .unlit = true};
        material.base_color_texture = texture;
        scene.materials.clear(), scene.meshes.clear(), scene.instances.clear();
        add(scene, quad, material);
        RenderSetup setup = seen_from({0, 1, 0}, vec3(0), 0.1f);
        setup.settings.samples = 1;
        return render(context(), scene, setup).rgb[0];
    };
    const Texture plain{.image = 0};
    EXPECT_EQ(color_at({0.25f, 0.25f}, plain), vec3(1, 0, 0));
    EXPECT_EQ(color_at({0.75f, 0.25f}, plain), vec3(0, 1, 0));
    EXPECT_EQ(color_at({0.25f, 0.75f}, plain), vec3(0, 0, 1));
    EXPECT_EQ(color_at({-0.75f, 3.25f}, plain), vec3(1, 0, 0));
    EXPECT_EQ(color_at({0.5f, 0.25f}, plain), vec3(0.5f, 0.5f, 0));  // halfway, filtered in linear light
    EXPECT_EQ(color_at({0, 0}, plain), vec3(0.5f, 0.5f, 0.5f));      // the corner of all four
    EXPECT_EQ(color_at({-3, -3}, {.image = 0, .wrap_u = Wrap::clamp_to_edge, .wrap_v = Wrap::clamp_to_edge}),
              vec3(1, 0, 0));
    EXPECT_EQ(color_at({1.25f, 0.25f}, {.image = 0, .wrap_u = Wrap::mirrored_repeat}), vec3(0, 1, 0));
    EXPECT_EQ(color_at({-0.25f, 0.25f}, {.image = 0, .wrap_u = Wrap::mirrored_repeat}), vec3(1, 0, 0));
    EXPECT_EQ(color_at({0.25f, 0.25f}, {.image = 0, .uv_row0 = vec3(1, 0, 0.5f)}), vec3(0, 1, 0));
    EXPECT_EQ(color_at({1e30f, -1e30f}, plain).x, color_at({0, 0}, plain).x)
        << "far beyond where floats have fractions";
}

TEST_F(PathTracer, MirroredAndScaledInstancesShadeAsTheirTransformSays) {
    const auto mean = [&](const Transform& transform) {
        Scene scene;
        add(scene, make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), lambert(1), transform);
        add(scene, square_above(), lamp(1), transform);
        RenderSetup setup =
            seen_from(transform_point(transform, {0, 0.5f, 0}), transform_point(transform, vec3(0)), 1e-4f);
        setup.settings.max_depth = 1;
        return render(context(), scene, setup);
    };
    for (const Transform& transform : {Transform::scaling({-1, 1, 1}), Transform::scaling(vec3(1e3f)),
                                       Transform::translation({0, 0, 1}) * Transform::scaling(vec3(1e-2f))})
        expect_mean(mean(transform), factor_of_square_above, "mirrored, enlarged, or shrunk and moved");
}

TEST_F(PathTracer, AnEmptySceneShowsItsSky) {
    RenderSetup setup = seen_from({0, 0, 1}, vec3(0), 0.3f);
    setup.environment = sky(0.5f);
    EXPECT_EQ(statistics(render(context(), Scene{}, setup)).mean, 0.5);
}

class RendererFilm : public test::VulkanTest {
  protected:
    // Renders these blocks of all pixels.
    static Film film_of(Renderer& renderer, AbstractAccel& accel, std::span<const uint> blocks) {
        Film film = renderer.make_film();
        renderer.start(film);
        for (const uint block : blocks) {
            renderer.add_block(accel, block);
            film.blocks.insert(block);
        }
        renderer.read(film);
        EXPECT_EQ(renderer.stats().non_finite, 0u);
        return film;
    }
    static bool same_pixels(const Film& a, const Film& b) {
        return a.pixels.size() == b.pixels.size() &&
               std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(FilmPixel)) == 0;
    }
};

TEST_F(RendererFilm, SumsAreThoseOfTheCpuTwinInAnyOrder) {
    const Scene scene = cornell_box_scene();
    const DeviceScene device_scene(context(), scene, collect_lights(scene), nullptr);
    SwTlas accel(context());
    push_scene(accel, scene);
    for (const uint block_size : {1u, 2u}) {
        Renderer renderer(
            context(), device_scene,
            {.width = 16, .height = 16, .block_size = block_size, .camera = camera_rays(scene.cameras[0], 1)});
        const Film all = film_of(renderer, accel, std::vector<uint>{0, 1, 2, 3});
        EXPECT_TRUE(same_pixels(all, film_of(renderer, accel, std::vector<uint>{2, 0, 3, 1})));
        Film merged = film_of(renderer, accel, std::vector<uint>{3, 1});
        merged.merge(film_of(renderer, accel, std::vector<uint>{0, 2}), "odd", "even");
        EXPECT_TRUE(same_pixels(all, merged));

        Film reference = renderer.make_film();
        std::vector<HdrImage> means;
        for (uint block = 0; block < 4; ++block) {
            means.push_back(film_of(renderer, accel, std::vector{block}).mean());
            for (std::size_t i = 0; i < reference.pixels.size(); ++i)
                reference.add(i, means[block].rgb[i] * static_cast<float>(block_size));
        }
        for (std::size_t i = 0; i < reference.pixels.size(); ++i)
            for (uint sum = 0; sum < FILM_SQUARES; ++sum)
                ASSERT_EQ(sum_of(all.pixels[i], sum), sum_of(reference.pixels[i], sum)) << i;
        // Luminance is a dot product, which compilers round in their own way.
        for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
            const double squares = sum_of(reference.pixels[i], FILM_SQUARES);
            ASSERT_NEAR(sum_of(all.pixels[i], FILM_SQUARES), squares, 1e-6 * squares) << i;
        }
        EXPECT_NE(0, std::memcmp(means[0].rgb.data(), means[1].rgb.data(), 256 * sizeof(vec3))) << "blocks differ";
    }
}

TEST_F(RendererFilm, PixelsThatAreNotAskedForStayAsTheyAre) {
    const Scene scene = cornell_box_scene();
    const DeviceScene device_scene(context(), scene, collect_lights(scene), nullptr);
    SwTlas accel(context());
    push_scene(accel, scene);
    Renderer renderer(context(), device_scene,
                      {.width = 16, .height = 16, .block_size = 2, .camera = camera_rays(scene.cameras[0], 1)});
    const Film all = film_of(renderer, accel, std::vector<uint>{0, 1});
    Film film = film_of(renderer, accel, std::vector<uint>{0});
    renderer.start(film);
    renderer.set_pixels(std::vector<uint>{5, 100});
    renderer.add_block(accel, 1);
    renderer.read(film);
    for (uint i = 0; i < 256; ++i) {
        const bool is_asked = i == 5 || i == 100;
        ASSERT_EQ(film.pixels[i].count, is_asked ? 2u : 1u);
        if (is_asked) {
            EXPECT_EQ(0, std::memcmp(&film.pixels[i], &all.pixels[i], sizeof(FilmPixel))) << i;
        }
    }
}

TEST_F(RendererFilm, FirstSurfacesAreWhatTheCameraSees) {
    Scene scene;
    Material screen = lambert(0);
    screen.alpha_mode = AlphaMode::mask;
    screen.base_color.w = 0;
    add(scene, make_quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}), screen);  // clear, before all others
    add(scene, make_quad({-1, 0, -1}, {0, 0, 2}, {1, 0, 0}), lambert(0.5f));
    add(scene, make_quad({0, -1, -1}, {0, 0, 2}, {1, 0, 0}), lamp(2));
    const DeviceScene device_scene(context(), scene, collect_lights(scene), nullptr);
    SwTlas accel(context());
    push_scene(accel, scene);
    // Seen from above, with +x to the left, the left half shows the lamp and the right half the grey quad.
    Renderer renderer(context(), device_scene,
                      {.width = 40, .height = 10, .camera = camera_rays(look({0, 9, 0}, vec3(0), 0.02f), 4)});
    const std::vector<FirstSurface> found = renderer.first_surfaces(accel);
    const FirstSurface &light = found[200 + 15], &grey = found[200 + 25];
    const auto rays = static_cast<float>(samples_of_first_surfaces);
    EXPECT_EQ(grey.albedo / rays, vec3(0.5f));
    EXPECT_EQ(grey.normal / rays, vec3(0, 1, 0));
    EXPECT_NEAR(grey.distance / rays, 9, 0.01f);
    EXPECT_EQ(grey.instance, 2u) << "1 + instance 1";
    EXPECT_NEAR(light.distance / rays, 10, 0.01f);
    EXPECT_EQ(light.instance, 3u);
    EXPECT_LT(light.primitive, 2u);
    EXPECT_EQ(light.count, samples_of_first_surfaces);
    // The film gets nothing of it.
    const Film all = film_of(renderer, accel, std::vector<uint>{0, 1});
    Film film = renderer.make_film();
    renderer.start(film);
    renderer.add_block(accel, 0);
    renderer.first_surfaces(accel);
    renderer.add_block(accel, 1);
    renderer.read(film);
    EXPECT_TRUE(same_pixels(film, all));
}

}  // namespace
}  // namespace twinray::path_tracer
