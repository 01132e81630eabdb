// SPDX-License-Identifier: MIT
// The contents of the renderer's films.
#include <cstring>

#include "tests/samples/render.h"

namespace twinray::path_tracer {
namespace {

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
