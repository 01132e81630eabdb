// SPDX-License-Identifier: MIT
// How many items submissions get, by what earlier ones took.
#include "engine/core/pace.h"

#include <gtest/gtest.h>

#include <random>

namespace twinray {
namespace {

constexpr double limit = 0.5;  // seconds

TEST(Pace, BeginsWithWhatTheSlowestDeviceCanDo) {
    EXPECT_EQ(first_items(0.5), 16384u);
    EXPECT_EQ(first_items(1), 32768u);
    EXPECT_EQ(first_items(1e-9), 64u) << "a group at least";
}

TEST(Pace, GrowsFourfoldWhileWorkIsShort) {
    EXPECT_EQ(next_items(16384, {16384, 1e-4}, limit), 65536u);
    EXPECT_EQ(next_items(16384, {16384, 0}, limit), 65536u) << "a clock that is too coarse";
    EXPECT_EQ(next_items(65536, {65536, 0.03125}, limit), 262144u) << "which is an eighth of a second";
}

TEST(Pace, AimsAtAQuarterOfTheLimit) {
    EXPECT_EQ(next_items(1 << 20, {1 << 20, 0.0625}, limit), 2u << 20);
    EXPECT_EQ(next_items(1 << 20, {1 << 20, 0.125}, limit), 1u << 20);
    EXPECT_EQ(next_items(1 << 20, {1 << 20, 1}, limit), 1u << 17) << "and shrinks at once";
    EXPECT_EQ(next_items(64, {64, 100}, limit), 64u);
    EXPECT_EQ(next_items(6400, {6400, 0.25}, limit), 3200u);
    EXPECT_EQ(next_items(6400, {6400, 0.26}, limit), 3072u) << "whole groups";
}

TEST(Pace, ARestIsNoMeasureUnlessItIsSlow) {
    EXPECT_EQ(next_items(1 << 20, {10, 1e-5}, limit), 1u << 20);
    EXPECT_EQ(next_items(1 << 20, {1 << 19, 0.25}, limit), 1u << 18);
}

TEST(Pace, KeepsBelowTheLimitWhereNeighboursTakeUpToFourTimesAsLong) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> exponent(5.5, 11), deviation(-1, 1);
        const double usual = std::pow(10, exponent(random));  // items a second
        std::uint64_t allowed = first_items(limit);
        double seconds = 0;
        for (int submission = 0; submission < 50; ++submission) {
            seconds = static_cast<double>(allowed) / (usual * std::exp2(deviation(random)));
            ASSERT_LE(seconds, limit * (1 + 1e-9)) << "seed " << seed << ", submission " << submission;
            allowed = next_items(allowed, {allowed, seconds}, limit);
        }
        EXPECT_GE(seconds, limit / 16 * (1 - 1e-9)) << "no shorter than it must be, seed " << seed;
    }
}

TEST(Pace, PassesThatNobodyMeasuresShareASubmissionWhereTheyAreSmall) {
    EXPECT_EQ(most_groups(0.5), 16384u);
    EXPECT_EQ(most_groups(1e-9), 0u);
    EXPECT_EQ(most_groups(0), UINT64_MAX) << "no limit";
}

}  // namespace
}  // namespace twinray
