// SPDX-License-Identifier: MIT
#include "bench/figures.h"

#include <gtest/gtest.h>

namespace twinray::bench {
namespace {

TraceRounds rounds_of(std::vector<double> ns_per_ray) {
    return {.n = 64, .ns_per_ray = std::move(ns_per_ray), .hash = {}, .soundness = {}};
}

TEST(BenchFigures, RatesAreMillionsASecond) {
    const Spread rate = mrays_per_s(rounds_of({100, 200, 1000}));
    EXPECT_DOUBLE_EQ(rate.median, 5);
    EXPECT_DOUBLE_EQ(rate.min, 1);
    EXPECT_DOUBLE_EQ(rate.max, 10);
}

// The machine was half as fast in the second round and in another in which only the baseline suffered.
TEST(BenchFigures, SpeedUpsCompareWithinARound) {
    EXPECT_DOUBLE_EQ(speed_up(rounds_of({100, 200, 100}), rounds_of({800, 800, 400})), 4);
    EXPECT_DOUBLE_EQ(speed_up(rounds_of({100, 200, 100}), rounds_of({100, 200, 100})), 1);
}

TEST(BenchFigures, LinesAreFitted) {
    const std::vector<double> x = {10, 13, 16, 20}, y = {25, 31, 37, 45};
    const Line line = fit_line(x, y);
    EXPECT_NEAR(line.offset, 5, 1e-12);
    EXPECT_NEAR(line.slope, 2, 1e-12);
    const std::vector<double> steps = {0, 1, 2}, scattered = {0, 0, 3};
    EXPECT_NEAR(fit_line(steps, scattered).offset, -0.5, 1e-12);
    EXPECT_NEAR(fit_line(steps, scattered).slope, 1.5, 1e-12);
}

}  // namespace
}  // namespace twinray::bench
