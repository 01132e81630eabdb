// SPDX-License-Identifier: MIT
// Figures of a bench, the table that shows them, and the hash of the hits that they belong to.
#include "bench/figures.h"
#include "bench/measure.h"
#include "engine/core/fnv1a.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

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

// The machine was half as fast in the second round, and in another round only the baseline suffered.
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

TEST(BenchTable, ColumnsAreAsWideAsTheirWidestCell) {
    std::ostringstream out;
    print_table(out, {{"name", "ms"}, {"a", "12.5"}});
    EXPECT_EQ(out.str(), "  name    ms\n  a     12.5\n");
}

TEST(BenchTable, NumbersKeepTheirDigits) {
    EXPECT_EQ(number_text(1234.4, 3), "1234");
    EXPECT_EQ(number_text(12.345, 3), "12.3");
    EXPECT_EQ(number_text(0.0012345, 3), "0.00123");
    EXPECT_EQ(number_text(0, 3), "0.00");
    EXPECT_EQ(number_text(-2, 2), "-2.0");
    EXPECT_EQ(number_text(NAN, 3), "-");
}

std::vector<Hit> two_hits() { return {{1, 2, 3, 4, 0.25f, 0.5f, 7, 0}, miss()}; }

std::uint64_t closest(const std::vector<Hit>& hits) { return hash_of(hits, Query::closest); }
std::uint64_t any(const std::vector<Hit>& hits) { return hash_of(hits, Query::any); }

TEST(HitsHash, IsFnv1a) {
    EXPECT_EQ(closest({}), 0xcbf29ce484222325u);  // its offset basis
    // The checksum of the bytes 01 00 00 00, from its definition.
    std::uint64_t expected = 0xcbf29ce484222325u;
    for (const std::uint64_t byte : {1u, 0u, 0u, 0u}) expected = (expected ^ byte) * 0x100000001b3u;
    EXPECT_EQ(any({{1, 2, 3, 4, 0.25f, 0.5f, 7, 0}}), expected);
    EXPECT_EQ(hexadecimal(0xcbf29ce484222325u), "cbf29ce484222325");
    EXPECT_EQ(hexadecimal(0x1f), "000000000000001f");
}

TEST(HitsHash, SeesTheOrder) {
    std::vector<Hit> swapped = two_hits();
    std::swap(swapped[0], swapped[1]);
    EXPECT_NE(closest(swapped), closest(two_hits()));
    EXPECT_NE(any(swapped), any(two_hits()));
}

TEST(HitsHash, SeesTheLastBitOfEachFieldThatCounts) {
    const auto changed = [](auto change) {
        std::vector<Hit> hits = two_hits();
        change(hits[0]);
        return closest(hits) != closest(two_hits());
    };
    EXPECT_TRUE(changed([](Hit& hit) { hit.hit = 0; }));
    EXPECT_TRUE(changed([](Hit& hit) { ++hit.primitive_index; }));
    EXPECT_TRUE(changed([](Hit& hit) { ++hit.instance_index; }));
    EXPECT_TRUE(changed([](Hit& hit) { hit.t = std::nextafter(hit.t, 9.0f); }));
    EXPECT_TRUE(changed([](Hit& hit) { hit.u = std::nextafter(hit.u, 9.0f); }));
    EXPECT_TRUE(changed([](Hit& hit) { hit.v = std::nextafter(hit.v, 9.0f); }));
    EXPECT_TRUE(changed([](Hit& hit) { std::swap(hit.u, hit.v); }));
    EXPECT_FALSE(changed([](Hit& hit) { ++hit.custom_index; }));
}

TEST(HitsHash, OfAnyHitsCountsHitAlone) {
    std::vector<Hit> hits = two_hits();
    hits[0].t = 9;
    hits[0].primitive_index = 9;
    EXPECT_EQ(any(hits), any(two_hits()));
    hits[1].hit = 1;
    EXPECT_NE(any(hits), any(two_hits()));
}

}  // namespace
}  // namespace twinray::bench
