// SPDX-License-Identifier: MIT
#include <twinray/analysis.h>

#include "tests/support/device.h"
#include "tests/support/errors.h"

namespace twinray::test {
namespace {

constexpr float hole = NAN;

class HorizonTest : public VulkanTest {
  protected:
    // Returns the slope eastward from the cell in column 0 of the middle row.
    float slope_east(const std::vector<float>& heights, uint columns, HorizonDesc desc = {}) {
        const vec2 east(1, 0);
        const uint rows = static_cast<uint>(heights.size()) / columns;
        desc.corner = {0, rows / 2}, desc.size = {1, 1}, desc.ways = {&east, 1};
        return horizon(context(), {.heights = heights, .columns = columns, .rows = rows}, desc).at(0);
    }
};

TEST_F(HorizonTest, TheSteepestPointCounts) {
    const std::vector<float> heights = {0, 0, 0, 0, 0,  //
                                        0, 1, 3, 2, 4,  //
                                        0, 0, 0, 0, 0};
    EXPECT_EQ(slope_east(heights, 5), 1.5f);
    EXPECT_EQ(slope_east(heights, 5, {.lift = 1}), 1.0f);
    EXPECT_EQ(slope_east(heights, 5, {.lift = 9}), 0.0f);
    EXPECT_EQ(slope_east(heights, 5, {.reach = 1}), 1.0f);
    EXPECT_EQ(slope_east(heights, 5, {.curvature = 0.5f}), 1.0f);
    EXPECT_FLOAT_EQ(slope_east(heights, 5, {.measure = HorizonMeasure::light}), 1 / 3.25f);
    EXPECT_FLOAT_EQ(slope_east(heights, 5, {.measure = HorizonMeasure::solid_angle}), 1 - 1.5f / std::sqrt(3.25f));
}

// An edge without a triangle is no surface.
TEST_F(HorizonTest, HolesHideNothing) {
    EXPECT_EQ(slope_east({hole, hole, hole, hole,  //
                          0, 0, 9, hole,           //
                          hole, hole, hole, hole},
                         4),
              0.0f);
    for (const bool is_above : {false, true}) {
        std::vector<float> heights = {hole, hole, hole, hole,  //
                                      0,    0,    8,    hole,  //
                                      hole, hole, 8,    hole};
        if (is_above) heights = {hole, 0, 8, hole, 0, 0, 8, hole, hole, hole, hole, hole};
        EXPECT_EQ(slope_east(heights, 4), 4.0f) << is_above;
    }
    EXPECT_TRUE(std::isnan(slope_east({0, 0, hole, 0}, 2)));
    EXPECT_TRUE(std::isnan(slope_east({0, 0, hole, 0}, 2, {.measure = HorizonMeasure::light})));
}

// Ways lead along a row, a column and a diagonal, from cells in a corner, at the border and inside.
TEST_F(HorizonTest, AnswersAreByCellThenByWay) {
    const std::vector<float> heights = {5, 0, 0, 0,  //
                                        0, 0, 0, 0,  //
                                        0, 0, 0, 3};
    const vec2 ways[] = {vec2(1, 0), vec2(0, -1), vec2(-1, -1)};
    const std::vector<float> found = horizon(context(), {.heights = heights, .columns = 4, .rows = 3},
                                             {.corner = {0, 1}, .size = {3, 2}, .ways = ways});
    const std::vector<float> wanted = {0,    5,    0, 0,    0, 5, 0, 0, 0,  //
                                       1.0f, 2.5f, 0, 1.5f, 0, 0, 3, 0, 2.5f};
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-12) << i;
}

TEST_F(HorizonTest, WrongArgumentsAreNamed) {
    const std::vector<float> heights(6);
    const vec2 ways[] = {vec2(1, 0)};
    const auto error = [&](const HeightRaster& raster, const HorizonDesc& desc) {
        return error_of([&] { horizon(context(), raster, desc); });
    };
    const HeightRaster raster{.heights = heights, .columns = 3, .rows = 2};
    expect_contains(error({.heights = heights, .columns = 6, .rows = 1}, {}), "6 heights for 6 x 1 cells");
    expect_contains(error({.heights = heights, .columns = 3, .rows = 3}, {}), "6 heights for 3 x 3 cells");
    expect_contains(error(raster, {.corner = {2, 0}, .size = {2, 1}}),
                    "2 x 1 cells from column 2, row 0 are not all within a raster of 3 x 2");
    const vec2 wrong_ways[] = {vec2(1, 0), vec2(INFINITY, 0), vec2(0, 0)};
    expect_contains(error(raster, {.size = {1, 1}, .ways = {wrong_ways, 2}}), "way 1 is (inf, 0)");
    expect_contains(error(raster, {.size = {1, 1}, .ways = {wrong_ways + 2, 1}}), "way 0 is (0, 0)");
    for (const vec2 way : {vec2(1, NAN), vec2(NAN, 1)})
        expect_contains(error(raster, {.size = {1, 1}, .ways = {&way, 1}}), "way 0 is (");
    expect_contains(error(raster, {.size = {1, 1}, .ways = ways, .lift = -1}), "lift is -1; wanted is at least 0");
    expect_contains(error(raster, {.size = {1, 1}, .ways = ways, .reach = NAN}), "reach is nan");
    EXPECT_TRUE(horizon(context(), raster, {.ways = ways}).empty());
}

}  // namespace
}  // namespace twinray::test
