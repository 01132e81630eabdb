// SPDX-License-Identifier: MIT
#include "engine/analysis/pair_sums.h"

#include <gtest/gtest.h>

#include <random>

namespace twinray {
namespace {

constexpr std::size_t chunk = 64;

// Rays of weights 1 +- `scatter`, of which a part is blocked.
PairSums sums_of(std::size_t chunks, double blocked, uint seed, float scatter = 0.5f) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    PairSums sums;
    for (std::size_t i = 0; i < chunks; ++i) {
        std::vector<float> weights(chunk);
        for (float& weight : weights) {
            weight = 1 + scatter * (2 * uniform(random) - 1);
            if (static_cast<double>(uniform(random)) < blocked) weight = -weight;
        }
        sums.add(weights, 2);
    }
    return sums;
}

TEST(PairSums, IsTheMeanOfFreeRays) {
    PairSums sums;
    std::vector<float> weights(chunk, 3.0f);
    sums.add(weights, 0.5);
    EXPECT_EQ(sums.rays(), chunk);
    EXPECT_EQ(sums.exchange(false).value, 1.5);
    EXPECT_EQ(sums.exchange(false).half_width(), 0);
    for (std::size_t i = 0; i < chunk; i += 2) weights[i] = -3.0f;
    sums.add(weights, 0.5);
    EXPECT_EQ(sums.exchange(true).value, 1.125);
}

TEST(PairSums, IntervalsHoldHoweverFewRaysAreBlockedOrFree) {
    // Without scatter the blocked rays alone tell: points of Sobol's come near that.
    for (const float scatter : {0.5f, 0.0f})
        for (const double blocked : {0.0, 0.001, 0.02, 0.5, 0.98, 0.999}) {
            int inside = 0;
            constexpr uint trials = 400;
            const double truth = 2 * (1 - blocked);
            for (uint seed = 1; seed <= trials; ++seed) {
                const Interval interval = sums_of(8, blocked, seed, scatter).exchange(true).interval_95;
                inside += interval.low <= truth && truth <= interval.high;
            }
            EXPECT_GE(inside, 0.92 * trials) << blocked << ", scatter " << scatter;
        }
}

TEST(PairSums, WhereAllIsBlockedTheIntervalTellsHowMuchMayBeFree) {
    const Estimate estimate = sums_of(16, 1, 1).exchange(true);
    EXPECT_EQ(estimate.value, 0);
    EXPECT_EQ(estimate.interval_95.low, 0);
    EXPECT_NEAR(estimate.interval_95.high, 3.7 / 1024 * 3, 1e-3) << "of rays as heavy as the heaviest";
}

}  // namespace
}  // namespace twinray
