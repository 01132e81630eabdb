// SPDX-License-Identifier: MIT
#include "viewer/picture/value_scale.h"

#include "tests/scene/temp_dir.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

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
    expect_contains(error_of([] { ValueScale::linear(1, 1); }), "from 1 to 1");
    expect_contains(error_of([] { ValueScale::linear(0, INFINITY); }), "from 0 to inf");
    expect_contains(error_of([] { ValueScale::logarithmic(0, 1); }), "from 0 to 1");
}

}  // namespace
}  // namespace twinray::test
