// Pictures without a device: views, scales of values, text, legends and matrices, as far as tests can judge them
// without eyes.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "engine/core/files.h"
#include "tests/scene/temp_dir.h"
#include "twinray/glsl/vector_math.h"
#include "viewer/picture/face_picture.h"
#include "viewer/picture/page.h"
#include "viewer/picture/raster.h"
#include "viewer/picture/value_scale.h"

namespace twinray::test {
namespace {

Scene boxes() {
    Scene scene;
    scene.meshes.push_back(make_box({3, -1, 5}, {9, 1, 6}));
    scene.instances = {{"one", 0, {}}, {"two", 0, Transform::translation({40, 2, -7})}};
    return scene;
}

void expect_near(vec3 a, vec3 b, float error) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], error) << i;
}

TEST(View, FramesAreFilledFromAnyDirection) {
    const Scene scene = boxes();
    using Direction = std::optional<vec3>;  // without one it is the usual one
    for (const Direction& direction : {Direction(), Direction({0, -1, 0}), Direction({0, 2, 0}),
                                       Direction({-1, -0.2f, 0.3f}), Direction({0, 0, 1e-30f})})
        for (const float aspect : {0.5f, 1.0f, 3.0f}) {
            const ImagePlane plane = image_plane(frame_scene(scene, aspect, direction), aspect);
            vec2 low(INFINITY), high(-INFINITY);
            for (const Instance& instance : scene.instances)
                for (const vec3& corner : scene.meshes[0].positions) {
                    const auto seen = project(plane, transform_point(instance.transform, corner));
                    ASSERT_TRUE(seen);
                    low = min(low, seen->point), high = max(high, seen->point);
                }
            const float edge = 1 / 1.04f;
            EXPECT_NEAR(std::max(high.x, high.y), edge, 0.01f) << aspect;
            EXPECT_NEAR(std::min(low.x, low.y), -edge, 0.01f) << aspect;
            if (direction)
                expect_near(plane.forward, normalize(*direction * (direction->z == 1e-30f ? 1e30f : 1.0f)), 1e-6f);
        }
}

TEST(View, LooksDownWithMinusZAtTheTop) {
    const ImagePlane plane = image_plane(frame_scene(boxes(), 1, vec3(0, -1, 0)), 1);
    expect_near(normalize(plane.up), vec3(0, 0, -1), 1e-6f);
    expect_near(normalize(plane.right), vec3(1, 0, 0), 1e-6f);
}

TEST(View, AnEmptySceneHasACamera) {
    const ImagePlane plane = image_plane(frame_scene({}, 1), 1);
    EXPECT_NEAR(length(plane.forward), 1, 1e-6f);
    EXPECT_EQ(plane.origin, vec3(0));
}

TEST(View, RefusesNoDirection) {
    expect_error("view direction (0, 0, 0) must be finite and not 0", [] { frame_scene({}, 1, vec3(0)); });
    expect_error("must be finite", [] { frame_scene({}, 1, vec3(NAN, 0, 1)); });
}

TEST(View, ProjectionsAreWhereRaysGo) {
    Camera camera = frame_scene(boxes(), 1.5f, vec3(-1, -2, -3));
    for (const bool is_orthographic : {false, true}) {
        if (is_orthographic) camera.orthographic_half_height = 4.0f;
        const ImagePlane plane = image_plane(camera, 1.5f);
        for (const vec2 at : {vec2(0), vec2(0.5f, -0.25f), vec2(-1, 1)}) {
            const Ray ray = ray_through(plane, at);
            const std::optional<Projected> seen = project(plane, ray.origin + 7.0f * ray.direction);
            ASSERT_TRUE(seen);
            EXPECT_NEAR(seen->point.x, at.x, 1e-5f);
            EXPECT_NEAR(seen->point.y, at.y, 1e-5f);
            EXPECT_NEAR(seen->depth, 7, 1e-4f);
        }
        EXPECT_FALSE(project(plane, plane.origin - plane.forward));
    }
}

std::string labels_of(const ValueScale& scale, std::size_t most) {
    std::vector<std::string> labels;
    for (const Tick& tick : scale.ticks(most)) labels.push_back(tick.label);
    return joined(labels);
}

// Relative luminance (IEC 61966-2-1), which lightness follows.
float luminance(Rgb color) { return dot(linear_of(color), vec3(0.2126f, 0.7152f, 0.0722f)); }

TEST(ColorMap, MagnitudesGetLighterAllTheWay) {
    for (int i = 1; i <= 100; ++i)
        EXPECT_GT(luminance(color_at(ColorMap::magnitude, i / 100.0)),
                  luminance(color_at(ColorMap::magnitude, (i - 1) / 100.0)))
            << i;
    EXPECT_EQ(color_at(ColorMap::magnitude, -1), (Rgb{68, 1, 84}));
    EXPECT_EQ(color_at(ColorMap::magnitude, 2), (Rgb{253, 231, 37}));
}

TEST(ColorMap, DivergingColorsAreLightestInTheMiddle) {
    const auto light = [](int percent) { return luminance(color_at(ColorMap::diverging, percent / 100.0)); };
    for (int i = 1; i <= 50; ++i) {
        EXPECT_GT(light(i), light(i - 1)) << i;
        EXPECT_GT(light(100 - i), light(101 - i)) << i;
    }
}

TEST(Srgb, EightBitsComeBackFromLinearLight) {
    for (int i = 0; i < 256; ++i) {
        const auto byte = static_cast<std::uint8_t>(i);
        EXPECT_EQ(rgb_of_linear(linear_of(Rgb{byte, byte, byte})), (Rgb{byte, byte, byte}));
    }
    EXPECT_NEAR(linear_of_srgb(0.5f), 0.21404f, 1e-5f);
}

TEST(ValueScale, TicksAreRoundNumbers) {
    EXPECT_EQ(labels_of(ValueScale::linear(0, 1), 6), "0, 0.2, 0.4, 0.6, 0.8, 1.0");
    EXPECT_EQ(labels_of(ValueScale::linear(0, 2.3), 6), "0, 0.5, 1.0, 1.5, 2.0");
    EXPECT_EQ(labels_of(ValueScale::linear(-0.13, 0.27), 6), "-0.1, 0, 0.1, 0.2");
    EXPECT_EQ(labels_of(ValueScale::linear(3, 4321), 6), "1000, 2000, 3000, 4000");
    EXPECT_EQ(labels_of(ValueScale::linear(0, 2e9), 3), "0, 1e9, 2e9");
    EXPECT_EQ(labels_of(ValueScale::linear(1e9, 1e9 + 4e6), 3), "1.000e9, 1.002e9, 1.004e9");
    EXPECT_EQ(labels_of(ValueScale::linear(0, 3e-7), 4), "0, 1e-7, 2e-7, 3e-7");
    EXPECT_NEAR(ValueScale::linear(0, 1).ticks(6)[1].position, 0.2, 1e-12);
}

TEST(ValueScale, LogarithmicTicksArePowersOfTen) {
    EXPECT_EQ(labels_of(ValueScale::logarithmic(0.0005, 200), 6), "0.001, 0.01, 0.1, 1, 10, 100");
    EXPECT_EQ(labels_of(ValueScale::logarithmic(0.5, 60), 10), "0.5, 1, 2, 5, 10, 20, 50");
    EXPECT_EQ(labels_of(ValueScale::logarithmic(1e-9, 1), 5), "1e-9, 1e-7, 1e-5, 0.001, 0.1");
    EXPECT_EQ(labels_of(ValueScale::logarithmic(3, 4), 3), "3.0, 3.5, 4.0");
    EXPECT_NEAR(ValueScale::logarithmic(1, 100).position(10), 0.5, 1e-12);
}

TEST(ValueScale, FitsValues) {
    const auto linear = [](std::vector<double> values) { return ValueScale::linear_for(values); };
    const auto logarithmic = [](std::vector<double> values) { return ValueScale::logarithmic_for(values); };
    EXPECT_EQ(linear({0.2, 0.93, NAN, INFINITY}).hi(), 1);
    EXPECT_EQ(linear({0.2}).lo(), 0);
    EXPECT_EQ(linear({-3, 1}).lo(), -3);
    EXPECT_EQ(linear({-3, 1}).hi(), 3);
    EXPECT_EQ(linear({}).hi(), 1);
    EXPECT_EQ(logarithmic({0, 0.25, 8}).lo(), 0.25);
    EXPECT_EQ(logarithmic({1e-30, 8}).lo(), 8e-6);
    EXPECT_EQ(logarithmic({8}).lo(), 0.8);
    EXPECT_EQ(logarithmic({}).hi(), 1);
}

TEST(ValueScale, ColorsTellWhereThereIsNoValue) {
    EXPECT_EQ(ValueScale::linear(0, 1).color(0), color_at(ColorMap::magnitude, 0));
    EXPECT_EQ(ValueScale::linear(-1, 1).color(0), color_at(ColorMap::diverging, 0.5));
    EXPECT_EQ(ValueScale::linear(0, 1).color(NAN), no_value_color);
    EXPECT_EQ(ValueScale::logarithmic(1, 10).color(0), no_value_color);
}

TEST(ValueScale, RefusesWhatIsNoRange) {
    expect_error("from 1 to 1", [] { ValueScale::linear(1, 1); });
    expect_error("from 0 to inf", [] { ValueScale::linear(0, INFINITY); });
    expect_error("from 0 to 1", [] { ValueScale::logarithmic(0, 1); });
}

Raster drawn(const std::string& text) {
    Raster raster(static_cast<uint>(text_width(text)), text_height);
    draw_text(raster, 0, 0, text);
    return raster;
}

std::size_t count_of(const Raster& raster, Rgb color) {
    return static_cast<std::size_t>(std::count(raster.pixels.begin(), raster.pixels.end(), color));
}

TEST(Font, EveryCharacterOfAsciiHasAGlyphOfItsOwn) {
    std::set<std::vector<Rgb>> glyphs;
    for (char c = ' '; c <= '~'; ++c) EXPECT_TRUE(glyphs.insert(drawn(std::string(1, c)).pixels).second) << c;
    EXPECT_EQ(drawn("\xc3\xa9\x01").pixels, drawn("??").pixels);
}

TEST(Font, TextIsCutToFit) {
    EXPECT_EQ(fitted("short", 100), "short");
    EXPECT_EQ(fitted("a long file name", 8 * text_advance), "a lon...");
    EXPECT_EQ(fitted("\xc3\xa9\xc3\xa9\xc3\xa9\xc3\xa9\xc3\xa9", 4 * text_advance), "\xc3\xa9...");
}

TEST(Raster, WhatIsOutsideIsCutOff) {
    Raster raster(4, 4, {0, 0, 0});
    fill(raster, {-5, 2, 7, 100}, {9, 9, 9});
    EXPECT_EQ(count_of(raster, {9, 9, 9}), 4u);
    EXPECT_EQ(raster.at(1, 2), (Rgb{9, 9, 9}));
    EXPECT_EQ(raster.at(2, 2), Rgb{});
}

TEST(Page, HoldsThePictureAndItsLegend) {
    const Rgb color = {1, 200, 3}, swatch = {200, 0, 100};
    const Raster page =
        compose(Raster(120, 200, color),
                {.title = "title",
                 .subtitle = "more",
                 .legend = {.title = "values", .scale = ValueScale::linear(0, 1), .entries = {{swatch, "of a name"}}}});
    EXPECT_EQ(count_of(page, color), 120u * 200u);
    EXPECT_GT(count_of(page, swatch), 100u);
    // Colours go through the map from the top of the bar to its bottom.
    const auto first = [&](Rgb wanted) { return std::ranges::find(page.pixels, wanted) - page.pixels.begin(); };
    EXPECT_LT(first({253, 231, 37}), first({68, 1, 84}));
    EXPECT_LT(first({68, 1, 84}), static_cast<std::ptrdiff_t>(page.pixels.size()));
    for (uint y = 0; y < page.height; ++y) EXPECT_EQ(page.at(page.width - 1, y), paper);  // nothing runs out
}

TEST(Png, OurOwnDecoderReadsIt) {
    const TempDir folder;
    const std::vector<Rgb> pixels = {{1, 2, 3}, {4, 5, 6}, {255, 0, 128}, {9, 9, 9}, {0, 0, 0}, {7, 8, 9}};
    write_png(folder / "a.png", 3, 2, pixels);
    const Image image = decode_image(read_file(folder / "a.png"), "a.png");
    ASSERT_EQ(image.width, 3u);
    ASSERT_EQ(image.height, 2u);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        EXPECT_EQ((Rgb{image.rgba[4 * i], image.rgba[4 * i + 1], image.rgba[4 * i + 2]}), pixels[i]) << i;
    expect_error("none/a.png", [&] { write_png(folder / "none/a.png", 3, 2, pixels); });
}

TEST(Matrix, LayoutFillsThePictureOrTakesMeans) {
    const auto layout = [](std::size_t size) {
        const MatrixLayout of = matrix_layout(size, 900);
        return std::array{of.entries_a_pixel, of.pixels_an_entry, of.pixels};
    };
    EXPECT_EQ(layout(10), (std::array{1u, 90u, 900u}));
    EXPECT_EQ(layout(900), (std::array{1u, 1u, 900u}));
    EXPECT_EQ(layout(901), (std::array{2u, 1u, 451u}));
    EXPECT_EQ(layout(100'000), (std::array{112u, 1u, 893u}));
}

TEST(Matrix, ShowsEntriesWhereTheyAre) {
    const std::vector<MatrixEntry> entries = {{0, 1, 1.0f}, {1, 0, 0.01f}};
    const Raster page = draw_matrix(2, entries, {});
    const Rgb high = color_at(ColorMap::magnitude, 1), low = color_at(ColorMap::magnitude, 0);
    // A square of 900 pixels: its quarters are white, high, low and white.
    EXPECT_GE(count_of(page, high), 450u * 450u);
    EXPECT_GE(count_of(page, low), 450u * 450u);
    const auto first = [&](Rgb color) {
        return static_cast<std::size_t>(std::ranges::find(page.pixels, color) - page.pixels.begin());
    };
    EXPECT_LT(first(high) / page.width, first(low) / page.width);  // row 0 is above row 1
    EXPECT_GT(first(high) % page.width, first(low) % page.width);  // column 1 is right of column 0
}

TEST(Matrix, PixelsAreMeansOfLargeOnes) {
    // Pixels of 2 x 2 entries: one of a single entry of 0.4, one of four of 0.1; both have the mean 0.1. The last
    // row and column are alone in their pixels.
    const std::vector<MatrixEntry> entries = {{0, 0, 0.4f}, {2, 4, 0.1f}, {2, 5, 0.1f},
                                              {3, 4, 0.1f}, {3, 5, 0.1f}, {900, 900, 0.1f}};
    const auto highest = [](std::span<const MatrixEntry> of) {
        return count_of(draw_matrix(901, of, {}), color_at(ColorMap::magnitude, 1));
    };
    EXPECT_EQ(highest(entries) - highest({}), 3u);
}

TEST(Picture, NormalsAreOfFrontsWhichMirroringKeeps) {
    Scene scene;
    scene.meshes = {make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0))};
    scene.instances = {{"as it is", 0, {}}, {"mirrored", 0, Transform::scaling({-1, 1, 1})}};
    for (uint instance = 0; instance < 2; ++instance) {
        Hit hit{};
        hit.instance_index = instance;
        EXPECT_EQ(front_normal(scene, hit), dvec3(0, 0, 1));
    }
}

}  // namespace
}  // namespace twinray::test
