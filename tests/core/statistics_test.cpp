#include "engine/core/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace twinray {
namespace {

TEST(Median, IsTheMiddle) {
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
    EXPECT_EQ(median({7}), 7);
    EXPECT_TRUE(std::isnan(median({})));
}

TEST(Median, AbsoluteDeviationIgnoresAnOutlier) {
    const std::vector<double> values = {1, 2, 3, 4, 1000};
    EXPECT_EQ(median_absolute_deviation(values), 1);
}

TEST(Quantile, IsLinearBetweenSamples) {
    const std::vector<double> sorted = {0, 10, 20, 30, 40};
    EXPECT_EQ(quantile(sorted, 0), 0);
    EXPECT_EQ(quantile(sorted, 1), 40);
    EXPECT_EQ(quantile(sorted, 0.5), 20);
    EXPECT_EQ(quantile(sorted, 0.125), 5);
}

// The ranks of Conover, "Practical Nonparametric Statistics", 3.2: for the median of 10 samples 2 and 9, of 6 the
// smallest and the largest.
TEST(Quantile, IntervalHasTheRanksOfTheBinomialDistribution) {
    std::vector<double> sorted;
    for (int i = 1; i <= 10; ++i) sorted.push_back(i);
    EXPECT_EQ(quantile_interval_95(sorted, 0.5), (Interval{2, 9}));
    sorted.resize(6);
    EXPECT_EQ(quantile_interval_95(sorted, 0.5), (Interval{1, 6}));
    sorted.resize(1);
    EXPECT_EQ(quantile_interval_95(sorted, 0.5), (Interval{1, 1}));
    EXPECT_EQ(quantile_interval_95(sorted, 0.99), (Interval{1, 1}));
}

TEST(Quantile, IntervalCoversTheTruthInAtLeast95OfAHundredTrials) {
    std::mt19937 random(7);
    int covered = 0;
    constexpr int trials = 4000;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> sorted;
        for (int i = 0; i < 100; ++i) sorted.push_back(static_cast<double>(random()) / 4294967296.0);
        std::sort(sorted.begin(), sorted.end());
        const Interval interval = quantile_interval_95(sorted, 0.8);
        if (interval.low <= 0.8 && 0.8 <= interval.high) ++covered;
    }
    EXPECT_GE(covered, trials * 0.94);
    EXPECT_LE(covered, trials * 0.985);
}

// Reference values: scipy's binomtest(k, n).proportion_ci() by bisection on the exact binomial tails.
TEST(MeanRate, IsTheRateOfOneStratumAndTheMeanOfMany) {
    for (const auto& [count, trials] : {std::pair{0u, 100u}, {5u, 100u}, {99u, 100u}, {100u, 100u}}) {
        const std::vector<Stratum> one = {{count, trials, 3}};
        const Interval mean = mean_rate_interval(one, 0.05), rate = rate_interval_95(count, trials);
        EXPECT_NEAR(mean.low, rate.low, 1e-12);
        EXPECT_NEAR(mean.high, rate.high, 1e-12);
        EXPECT_DOUBLE_EQ(mean_rate(one), count / 100.0);
    }
    const std::vector<Stratum> many = {{10, 100, 1}, {0, 1'000'000, 1}, {0, 0, 5}};
    EXPECT_DOUBLE_EQ(mean_rate(many), 0.05) << "whatever the numbers of trials";
    EXPECT_EQ(mean_rate_interval({}, 0.05), (Interval{0, 1}));
    EXPECT_TRUE(std::isnan(mean_rate({})));
}

// Strata have unlike rates, weights and sizes, and the largest rate has the fewest trials.
TEST(MeanRate, ItsIntervalHoldsTheTruthAsOftenAsItSays) {
    std::mt19937_64 random(1);
    for (const double scale : {0.0, 1e-4, 1e-3, 1e-2, 0.3}) {
        constexpr int repeats = 2000;
        int held = 0;
        for (int repeat = 0; repeat < repeats; ++repeat) {
            double truth = 0;
            std::vector<Stratum> strata;
            for (int i = 0; i < 6; ++i) {
                const double rate = scale * i;
                if (rate > 1) continue;
                const std::uint64_t trials = 8192u >> i;
                strata.push_back({std::binomial_distribution<std::uint64_t>(trials, rate)(random), trials, 1.0 + i});
                truth += rate * (1.0 + i);
            }
            double weights = 0;
            for (const Stratum& stratum : strata) weights += stratum.weight;
            const Interval interval = mean_rate_interval(strata, 0.05);
            held += interval.low <= truth / weights && truth / weights <= interval.high;
        }
        EXPECT_GE(held, 0.95 * repeats) << scale;
    }
}

TEST(RateInterval95, IsClopperPearsons) {
    EXPECT_NEAR(rate_interval_95(5, 100).low, 0.0164319, 1e-6);
    EXPECT_NEAR(rate_interval_95(5, 100).high, 0.1128349, 1e-6);
    EXPECT_EQ(rate_interval_95(0, 100).low, 0);
    EXPECT_NEAR(rate_interval_95(0, 100).high, 0.0362167, 1e-6);
    EXPECT_EQ(rate_interval_95(100, 100).high, 1);
    EXPECT_EQ(rate_interval_95(0, 0), (Interval{0, 1}));
}

TEST(PowerLaw, OfExactPointsHasNoUncertainty) {
    std::vector<double> x, y;
    for (const double value : {1.0, 2.0, 8.0, 64.0}) {
        x.push_back(value);
        y.push_back(3 * std::pow(value, -0.5));
    }
    const std::optional<PowerLaw> fit = fit_power_law(x, y);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, -0.5, 1e-12);
    EXPECT_NEAR(fit->scale, 3, 1e-12);
    EXPECT_NEAR(fit->slope_95.low, -0.5, 1e-9);
    EXPECT_NEAR(fit->slope_95.high, -0.5, 1e-9);
    EXPECT_EQ(fit->points, 4u);
}

// log10 x = 0, 1, 2, 3 and log10 y = 0, 1.1, 1.9, 3.2: slope 1.04, residual 0.042, t(2) = 4.302653.
TEST(PowerLaw, IntervalIsStudents) {
    const std::vector<double> x = {1, 10, 100, 1000};
    const std::vector<double> y = {1, std::pow(10, 1.1), std::pow(10, 1.9), std::pow(10, 3.2)};
    const std::optional<PowerLaw> fit = fit_power_law(x, y);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, 1.04, 1e-12);
    EXPECT_NEAR(fit->slope_95.high - fit->slope, 4.302653 * std::sqrt(0.042 / 2 / 5), 1e-5);
}

TEST(PowerLaw, NeedsThreePositivePointsOverAFactorOfTwo) {
    const std::vector<double> two = {1, 2};
    EXPECT_FALSE(fit_power_law(two, two));
    const std::vector<double> x = {1, 0, 2, INFINITY}, y = {1, 1, 2, 3};
    EXPECT_FALSE(fit_power_law(x, y));
    const std::vector<double> same = {2, 2, 2}, different = {1, 2, 3};
    EXPECT_FALSE(fit_power_law(same, different));
    const std::vector<double> near = {0.4939, 0.495, 0.4954}, wide = {0.25, 0.3, 0.5}, times = {357, 254, 759};
    EXPECT_FALSE(fit_power_law(near, times));
    EXPECT_TRUE(fit_power_law(wide, times));
}

// Reference values: bisection on the binomial tail summed term by term in Python's math module.
TEST(UpperBound95, IsClopperPearsons) {
    EXPECT_NEAR(upper_bound_95(0, 1000), 0.0029912495451, 1e-12);
    EXPECT_NEAR(upper_bound_95(1, 100), 0.0465598114535, 1e-10);
    EXPECT_NEAR(upper_bound_95(5, 100), 0.102253377643, 1e-10);
    EXPECT_NEAR(upper_bound_95(3, 1000000), 7.75363810049e-06, 1e-13);
    EXPECT_NEAR(upper_bound_95(1000, 1000000), 0.00105357487745, 1e-11);
    EXPECT_NEAR(upper_bound_95(99, 100), 0.999487198584, 1e-10);
    EXPECT_NEAR(upper_bound_95(50, 60), 0.906693067295, 1e-10);
}

TEST(UpperBound95, OfNoEventIsTheRuleOfThree) {
    for (const std::uint64_t n : {1000u, 1000000u, 1000000000u})
        EXPECT_NEAR(upper_bound_95(0, n) * static_cast<double>(n), 3, 0.01);
}

TEST(UpperBound95, IsOneWhereNothingIsKnown) {
    EXPECT_EQ(upper_bound_95(0, 0), 1);
    EXPECT_EQ(upper_bound_95(5, 5), 1);
    EXPECT_EQ(upper_bound_95(6, 5), 1);
}

TEST(UpperBound95, GrowsWithTheCount) {
    double before = 0;
    for (std::uint64_t count = 0; count < 100000; count += 997) {
        const double bound = upper_bound_95(count, 100000);
        EXPECT_GT(bound, before);
        EXPECT_GT(bound, static_cast<double>(count) / 100000);
        before = bound;
    }
}

// Chances of events differ, as for the part of a face seen through cells that it covers wholly, in part and not at all.
TEST(PairedCount, IntervalCoversTheMeanCountOfUnlikeTrials) {
    std::mt19937 random(11);
    const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
    for (const std::size_t partly : {0, 2, 40, 400}) {
        for (const std::size_t wholly : {0, 1000}) {
            std::vector<double> chances(2001, 0);
            std::fill_n(chances.begin(), wholly, 1);
            for (std::size_t i = 0; i < partly; ++i) chances[wholly + i] = 0.05 + 0.9 * unit();
            double mean = 0, width = 0;
            for (const double chance : chances) mean += chance;
            int missed = 0;
            constexpr int trials = 1000;
            for (int trial = 0; trial < trials; ++trial) {
                std::uint64_t count = 0, odd = 0;
                for (std::size_t i = 0; i < chances.size(); i += 2) {
                    const bool first = unit() < chances[i];
                    const bool second = i + 1 < chances.size() && unit() < chances[i + 1];
                    count += first + second;
                    odd += first != second;
                }
                const Interval interval = paired_count_interval_95(count, odd, chances.size());
                missed += mean < interval.low || mean > interval.high;
                width += (interval.high - interval.low) / trials;
            }
            EXPECT_LE(missed, trials * 0.05) << partly << " of " << wholly;
            const double expected = 24 + 8 * std::sqrt(static_cast<double>(partly));
            EXPECT_LT(width, expected) << partly << " of " << wholly;
        }
    }
}

TEST(PairedCount, IntervalIsWithinWhatCanBe) {
    EXPECT_EQ(paired_count_interval_95(0, 0, 0), (Interval{0, 0}));
    EXPECT_EQ(paired_count_interval_95(0, 0, 10).low, 0);
    EXPECT_EQ(paired_count_interval_95(10, 0, 10).high, 10);
    EXPECT_LE(paired_count_interval_95(0, 0, 1000).high, rate_interval(0, 1000, 0.025).high * 1000);
    EXPECT_EQ(rate_interval(3, 70, 0.05), rate_interval_95(3, 70));
    EXPECT_LT(rate_interval(3, 70, 0.01).low, rate_interval_95(3, 70).low);
}

// Weights that are summed occur or not, such as hours of sun.
TEST(PairedMargin, CoversWeightedSums) {
    std::mt19937 random(13);
    const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
    int missed = 0;
    constexpr int trials = 2000;
    for (int trial = 0; trial < trials; ++trial) {
        double sum = 0, mean = 0, squares = 0;
        for (int pair = 0; pair < 100; ++pair) {
            const double weight = pair % 5 + 1, chance = pair % 10 < 3 ? 0.5 : pair % 10 < 6 ? 1 : 0.02;
            const bool first = unit() < chance, second = unit() < chance;
            mean += 2 * weight * chance;
            sum += weight * (first + second);
            squares += weight * weight * (first != second);
        }
        missed += std::abs(sum - mean) > paired_margin(squares, 5, 0.05);
    }
    EXPECT_LE(missed, trials * 0.05);
    EXPECT_NEAR(paired_margin(0, 1, 0.05), 9.89, 0.01);  // for a variance of up to 9.2
    EXPECT_NEAR(paired_margin(100, 1, 0.05), 33.86, 0.01);
    EXPECT_NEAR(paired_margin(2500, 5, 0.05), 5 * 33.86, 0.05);
    EXPECT_GT(paired_margin(200, 5, 0.01), paired_margin(200, 5, 0.05));
}

// Intervals for means of 30 numbers that are 1 with a probability of 0.3.
TEST(Bootstrap, CoversAMeanAboutAsOftenAsItSays) {
    std::mt19937 random(7);
    int covered = 0;
    double width = 0;
    constexpr int trials = 200;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> values;
        for (int i = 0; i < 30; ++i) values.push_back(random() % 10 < 3);
        const Interval interval = bootstrap_interval_95(values.size(), [&](std::span<const std::size_t> items) {
            double sum = 0;
            for (const std::size_t item : items) sum += values[item];
            return sum / static_cast<double>(items.size());
        });
        width += (interval.high - interval.low) / trials;
        covered += interval.low <= 0.3 && 0.3 <= interval.high;
    }
    EXPECT_NEAR(width, 2 * 1.96 * std::sqrt(0.3 * 0.7 / 30), 0.02);
    EXPECT_GE(covered, trials * 0.87);
    EXPECT_LT(covered, trials);
}

TEST(Bootstrap, OfOneItemIsThatItem) {
    const auto first = [](std::span<const std::size_t> items) { return static_cast<double>(items.size() + items[0]); };
    EXPECT_EQ(bootstrap_interval_95(1, first), (Interval{1, 1}));
}

}  // namespace
}  // namespace twinray
