// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "renderer/environment.h"
#include "renderer/lights.h"

namespace twinray::path_tracer {
namespace {

using std::numbers::pi;

// Every elementary interval of every aligned block of 2^k samples holds one of them.
TEST(SamplePair, IsStratifiedInEveryWayThatTwoDimensionsAllow) {
    for (uint pixel = 0; pixel < 20; ++pixel)
        for (uint k = 1; k <= 8; ++k)
            for (uint block = 0; block < 3; ++block)
                for (uint a = 0; a <= k; ++a) {
                    std::set<std::uint64_t> cells;
                    for (uint i = 0; i < 1u << k; ++i) {
                        const uvec2 pair = sample_pair(pixel, (block << k) + i, 5, 9);
                        cells.insert((std::uint64_t{pair.x} << a >> 32) << 32 | std::uint64_t{pair.y} << (k - a) >> 32);
                    }
                    ASSERT_EQ(cells.size(), 1u << k) << "pixel " << pixel << " block " << block << " a " << a;
                }
}

TEST(SamplePair, PixelsDimensionsAndSeedsAreUncorrelated) {
    const auto correlation = [](auto first, auto second) {
        constexpr uint count = 1 << 14;
        double sum = 0;
        for (uint i = 0; i < count; ++i)
            sum += (double{unit_float(first(i))} - 0.5) * (double{unit_float(second(i))} - 0.5);
        return sum / count * 12;
    };
    const auto base = [](uint i) { return sample_pair(i, 3, 1, 1).x; };
    const double bound = 4 / std::sqrt(1 << 14);
    EXPECT_LT(std::abs(correlation(base, [](uint i) { return sample_pair(i, 3, 1, 1).y; })), bound);
    EXPECT_LT(std::abs(correlation(base, [](uint i) { return sample_pair(i + 1, 3, 1, 1).x; })), bound);
    EXPECT_LT(std::abs(correlation(base, [](uint i) { return sample_pair(i, 3, 2, 1).x; })), bound);
    EXPECT_LT(std::abs(correlation(base, [](uint i) { return sample_pair(i, 3, 1, 2).x; })), bound);
    // The two samples of an aligned pair lie in opposite halves.
    EXPECT_NEAR(correlation(base, [](uint i) { return sample_pair(i, 2, 1, 1).x; }), -0.75, bound);
}

TEST(UnitCircle, IsAccurateToFloatRounding) {
    for (int i = -4096; i <= 4096; ++i) {
        const float turns = static_cast<float>(i) / 2048;
        const vec2 circle = unit_circle(turns);
        const double angle = 2 * pi * static_cast<double>(turns);
        EXPECT_NEAR(circle.x, std::cos(angle), 2e-7) << turns;
        EXPECT_NEAR(circle.y, std::sin(angle), 2e-7) << turns;
    }
}

TEST(FrameAbout, IsOrthonormalEverywhere) {
    for (uint i = 0; i < 1000; ++i) {
        const vec2 u = unit_floats(sample_pair(i, 0, 0, 1));
        const vec2 circle = unit_circle(u.x) * sqrt(1 - (2 * u.y - 1) * (2 * u.y - 1));
        const Frame frame = frame_about(vec3(circle.x, circle.y, 2 * u.y - 1));
        EXPECT_NEAR(length(cross(frame.x, frame.y) - frame.z), 0, 1e-6f);
        EXPECT_NEAR(dot(frame.x, frame.z), 0, 1e-6f);
    }
}

TEST(MisWeight, SumsToOneAndDoesNotOverflow) {
    EXPECT_FLOAT_EQ(mis_weight(2, 3) + mis_weight(3, 2), 1);
    EXPECT_EQ(mis_weight(1, 0), 1);
    EXPECT_EQ(mis_weight(0, 5), 1);
    EXPECT_FLOAT_EQ(mis_weight(1e30f, 1e30f), 0.5f);
    EXPECT_EQ(mis_weight(1e-30f, 1e30f), 0);
}

// Returns the exact probability of each entry, from the columns.
std::vector<double> probabilities(const std::vector<AliasEntry>& table) {
    std::vector<double> result(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double probability = table[i].probability * 0x1p-32;
        result[i] += probability / static_cast<double>(table.size());
        result[table[i].alias] += (1 - probability) / static_cast<double>(table.size());
    }
    return result;
}

TEST(AliasTable, GivesEachEntryItsProbability) {
    std::mt19937 random(7);
    for (const std::size_t n : {1u, 2u, 3u, 1000u}) {
        std::vector<double> weights(n);
        for (double& w : weights)
            w = std::uniform_real_distribution<double>(0, 1)(random) < 0.3 ? 0 : static_cast<double>(random()) * 1e-9;
        weights[0] = 5;
        double total = 0;
        for (const double w : weights) total += w;
        const std::vector<double> chosen = probabilities(make_alias_table(weights));
        for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(chosen[i], weights[i] / total, 1e-8) << n << ' ' << i;
    }
}

TEST(AliasTable, OfNothingIsEmpty) {
    EXPECT_TRUE(make_alias_table({}).empty());
    EXPECT_TRUE(make_alias_table(std::vector<double>{0, 0}).empty());
}

TEST(EnvironmentMap, DensityIntegratesToOneOverTheSphere) {
    std::mt19937 random(3);
    HdrImage image{7, 5, std::vector<vec3>(35)};
    for (vec3& pixel : image.rgb) pixel = vec3(static_cast<float>(random() % 100));
    const EnvironmentMap map(image);
    double total = 0;
    for (uint y = 0; y < 5; ++y)
        for (uint x = 0; x < 7; ++x)
            total += static_cast<double>(luminance(image.rgb[y * 7 + x]) * map.density_per_luminance) * 2 * pi / 7 *
                     (std::cos(pi * y / 5) - std::cos(pi * (y + 1) / 5));
    EXPECT_NEAR(total, 1, 1e-6);
}

TEST(EnvironmentMap, OfNothingIsBlack) {
    EXPECT_TRUE(EnvironmentMap(constant_sky(vec3(0))).is_black());
    EXPECT_FALSE(EnvironmentMap(default_sky()).is_black());
}

}  // namespace
}  // namespace twinray::path_tracer
