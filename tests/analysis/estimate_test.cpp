// Estimates from rays that were counted or weighed, with their intervals; and the points that rays start from.
#include "engine/analysis/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "twinray/glsl/cpp_sampling.h"

namespace twinray {
namespace {

TEST(Within, NothingLeavesWhatIsPossibleAndIntervalsHoldTheirValues) {
    const auto expect = [](double value, const Interval& interval, double right, const Interval& right_interval) {
        const Estimate estimate = within({1, 3}, value, interval);
        EXPECT_EQ(estimate.value, right) << value;
        EXPECT_EQ(estimate.interval_95, right_interval) << value << ": " << interval.low << ", " << interval.high;
    };
    expect(2, {1.5, 2.5}, 2, {1.5, 2.5});
    expect(2, {0, 4}, 2, {1, 3});
    expect(3.5, {2, 3.75}, 3, {2, 3});
    expect(3.5, {3.25, 3.75}, 3, {3, 3});
    expect(0.5, {0.25, 0.75}, 1, {1, 1});
    expect(2, {2.25, 2.5}, 2, {2, 2.5});
    expect(2, {1.25, 1.5}, 2, {1.25, 2});
}

// Weights of rays are rounded, and so may their sum be.
TEST(FractionEstimator, OfAllRaysIsNoMoreThanAll) {
    Replicates fractions;
    fractions.fill(1 + 0x1p-50);
    for (const std::uint64_t events : {16000u, 15000u}) {
        const Estimate estimate = FractionEstimator()(fractions, events, 16000);
        EXPECT_EQ(estimate.value, 1) << events;
        EXPECT_EQ(estimate.interval_95.high, 1) << events;
        EXPECT_LT(estimate.interval_95.low, 1) << events;
    }
}

TEST(FractionEstimator, OfManyEventsIsStudentsInterval) {
    Replicates fractions;
    for (std::size_t i = 0; i < replicate_count; ++i) fractions[i] = i % 2 ? 0.3 : 0.2;
    const Estimate estimate = FractionEstimator()(fractions, 4000, 16000);
    EXPECT_DOUBLE_EQ(estimate.value, 0.25);
    // Standard error 0.05 sqrt(16 / 15) / 4; Student's quantile for 15 degrees of freedom is 2.13145.
    EXPECT_NEAR(estimate.half_width(), 2.13145 * 0.05 * std::sqrt(16.0 / 15) / 4, 1e-6);
    EXPECT_NEAR(estimate.interval_95.low + estimate.interval_95.high, 0.5, 1e-15);
}

// Stratified rays leave a panel beside a wide floor, and every replicate sees exactly half of them reach it.
TEST(FractionEstimator, OfReplicatesThatAgreeLeavesRoomForWhatNoRaySaw) {
    Replicates fractions;
    fractions.fill(0.5);
    const Estimate estimate = FractionEstimator()(fractions, 512, 1024);
    EXPECT_EQ(estimate.value, 0.5);
    EXPECT_NEAR(estimate.half_width(), 3.7 / 1024, 0.1 / 1024);
}

TEST(FractionEstimator, OfFewEventsIsThatOfCounts) {
    FractionEstimator estimate;
    Replicates all;
    all.fill(1);
    const Estimate never = estimate({}, 0, 16000), always = estimate(all, 16000, 16000);
    EXPECT_EQ(never.interval_95, rate_interval_95(0, 16000));
    EXPECT_GT(never.interval_95.high, 2e-4);
    EXPECT_EQ(always.interval_95, rate_interval_95(16000, 16000));
    Replicates few{};
    few[3] = 3.0 / 1000;
    const Estimate three = estimate(few, 3, 16000);
    EXPECT_EQ(three.interval_95, rate_interval_95(3, 16000));
    EXPECT_EQ(estimate(few, 3, 16000).interval_95, three.interval_95) << "the second time, too";
}

TEST(RowSums, CountsByTargetAndReplicate) {
    RowSums sums;
    std::vector<uint> targets(64, 7);  // 4 of each replicate
    targets[0] = targets[5] = 3;       // of replicates 0 and 1
    sums.add(targets, 1);
    sums.settle();
    sums.add(std::vector<uint>(64, 3), 0.5);
    sums.settle();
    EXPECT_EQ(sums.rays(), 128u);
    ASSERT_EQ(sums.entries().size(), 2u);
    const RowSums::Entry &three = sums.entries()[0], &seven = sums.entries()[1];
    EXPECT_EQ(three.target, 3u);
    EXPECT_EQ(three.hits, 66u);
    EXPECT_EQ(three.sums[0], 1 + 4 * 0.5);
    EXPECT_EQ(three.sums[1], 1 + 4 * 0.5);
    EXPECT_EQ(three.sums[2], 4 * 0.5);
    EXPECT_EQ(seven.hits, 62u);
    EXPECT_EQ(seven.sums[0], 3);
    EXPECT_EQ(seven.sums[15], 4);
    FractionEstimator estimator;
    EXPECT_NEAR(sums.estimate(three, 6, estimator).value, (2 * 3.0 + 14 * 2.0) / 16 / 6, 1e-15);
}

// The points of scipy.stats.qmc.Sobol(4, scramble=False), which come in another order.
TEST(Sobol, HasTheDirectionNumbersOfJoeAndKuo) {
    const auto half = [](double x) { return static_cast<uint>(std::ldexp(x, 32)); };
    EXPECT_EQ(sobol_third_and_fourth(0), uvec2(0));
    EXPECT_EQ(sobol_third_and_fourth(1), uvec2(half(0.5), half(0.5)));
    EXPECT_EQ(sobol_third_and_fourth(3), uvec2(half(0.25), half(0.25)));
    EXPECT_EQ(sobol_third_and_fourth(2), uvec2(half(0.75), half(0.75)));
    EXPECT_EQ(sobol_third_and_fourth(6), uvec2(half(0.625), half(0.875)));
    EXPECT_EQ(sobol_third_and_fourth(7), uvec2(half(0.125), half(0.375)));
    EXPECT_EQ(sobol_third_and_fourth(5), uvec2(half(0.875), half(0.625)));
    EXPECT_EQ(sobol_third_and_fourth(4), uvec2(half(0.375), half(0.125)));
}

TEST(Sobol, EachDimensionOfAScrambledSequenceIsStratified) {
    constexpr uint bits = 10;
    for (uint key = 0; key < 8; ++key) {
        std::vector<int> seen(4 << bits);
        for (uint i = 0; i < 1u << bits; ++i) {
            const uvec4 point = sobol_point(uvec4(key, 2, 3, 4), i);
            for (uint d = 0; d < 4; ++d) seen[d << bits | point[static_cast<int>(d)] >> (32 - bits)] += 1;
        }
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(seen.size())) << "key " << key;
    }
}

TEST(Sobol, KeysAreIndependent) {
    double product = 0;
    constexpr uint keys = 4096;
    for (uint key = 0; key < keys; ++key)
        product += (unit_float(sobol_point(uvec4(key, 0, 0, 0), 5).x) - 0.5) *
                   (unit_float(sobol_point(uvec4(key, 1, 0, 0), 5).x) - 0.5);
    EXPECT_LT(std::abs(product / keys), 4.0 / 12 / std::sqrt(keys));
}

constexpr std::size_t chunk = 64;

// Returns the sums of rays with weights of 1 +- `scatter`, some of which are blocked.
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
    // Without scatter only the blocked rays tell the error; Sobol's points come near that.
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
