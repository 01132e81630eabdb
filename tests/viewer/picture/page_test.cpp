// SPDX-License-Identifier: MIT
// Text, legends and matrices: what can be told of them without eyes.
#include "viewer/picture/page.h"

#include <algorithm>
#include <set>

#include <twinray/scene.h>

#include "engine/core/files.h"
#include "viewer/picture/font.h"
#include "viewer/picture/matrix_picture.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

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
    // From the top of the bar to its bottom colours go through the map.
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
    expect_contains(error_of([&] { write_png(folder / "none/a.png", 3, 2, pixels); }), "none/a.png");
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

}  // namespace
}  // namespace twinray::test
