// Backends are measured in turns, over as many tiles of the rays as the time allows; the figures, the table that shows
// them, and the hash of the hits that they belong to.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "bench/report.h"
#include "bench/measure.h"
#include "engine/core/fnv1a.h"

namespace twinray::bench {
namespace {

// Ray i has t_max i.
std::vector<Ray> numbered(std::size_t count) {
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) rays[i].t_max = static_cast<float>(i);
    return rays;
}

// Returns the numbers of the tiles, and fails unless each is whole.
std::vector<std::size_t> tiles_of(const std::vector<Ray>& rays) {
    std::vector<std::size_t> tiles;
    EXPECT_EQ(rays.size() % rays_a_tile, 0u);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto number = static_cast<std::size_t>(rays[i].t_max);
        if (i % rays_a_tile == 0) tiles.push_back(number / rays_a_tile);
        EXPECT_EQ(number, tiles.back() * rays_a_tile + i % rays_a_tile);
    }
    return tiles;
}

TEST(Tiles, AreCountedWithTheLastOneThatIsNotWhole) {
    EXPECT_EQ(count_tiles(0), 0u);
    EXPECT_EQ(count_tiles(64), 1u);
    EXPECT_EQ(count_tiles(65), 2u);
}

TEST(Tiles, AreWholeAndSpreadEvenly) {
    const std::vector<Ray> rays = numbered(100 * rays_a_tile);
    EXPECT_EQ(tiles_of(even_tiles(rays, 1)), (std::vector<std::size_t>{50}));
    EXPECT_EQ(tiles_of(even_tiles(rays, 4)), (std::vector<std::size_t>{12, 37, 62, 87}));
    for (const std::size_t wanted : {3u, 7u, 33u, 50u, 51u, 99u}) {
        SCOPED_TRACE(wanted);
        const std::vector<std::size_t> tiles = tiles_of(even_tiles(rays, wanted));
        ASSERT_EQ(tiles.size(), wanted);
        for (std::size_t i = 1; i < tiles.size(); ++i) {
            EXPECT_GE(tiles[i] - tiles[i - 1], 100 / wanted);
            EXPECT_LE(tiles[i] - tiles[i - 1], 100 / wanted + 1);
        }
    }
}

TEST(Tiles, AllAreTakenWhereNoMoreAreThere) {
    const std::vector<Ray> rays = numbered(100);  // the second is not whole
    EXPECT_EQ(even_tiles(rays, 2).size(), 100u);
    EXPECT_EQ(even_tiles(rays, 1000).size(), 100u);
    EXPECT_TRUE(even_tiles({}, 3).empty());
}

// Reports that it takes `ns_per_ray`, the first time 1000 times as long, and records whose turn it was.
class FakeBackend : public Backend {
  public:
    FakeBackend(std::string name, double ns_per_ray, std::vector<std::string>& log)
        : Backend({.name = std::move(name),
                   .backend = "sw",
                   .path = "",
                   .order = "",
                   .layout = "",
                   .builder = "",
                   .level = ""}),
          ns_per_ray_(ns_per_ray),
          log_(log) {}

    BuildFigures build(const Scene&) override {
        log_.push_back("build " + labels().name);
        return {.ms = static_cast<double>(log_.size())};
    }
    double trace(const RayBatch& batch) override {
        log_.push_back(labels().name);
        const double slowness = was_traced_ ? 1 : 1000;
        was_traced_ = true;
        return slowness * ns_per_ray_ * static_cast<double>(batch.rays().size()) * 1e-6;
    }
    std::vector<Hit> hits(const RayBatch& batch) const override {
        return std::vector<Hit>(batch.rays().size(), miss());
    }

  private:
    double ns_per_ray_;
    std::vector<std::string>& log_;
    bool was_traced_ = false;
};

RayBatch batch_of(std::size_t tiles) { return {std::vector<Ray>(tiles * rays_a_tile), Query::closest, false}; }

std::size_t affordable(double ns_per_ray, std::size_t tiles, double max_ms) {
    std::vector<std::string> log;
    FakeBackend backend("a", ns_per_ray, log);
    return affordable_tiles(backend, batch_of(tiles), max_ms);
}

TEST(AffordableTiles, AreAllForWhoIsFast) {
    EXPECT_EQ(affordable(100, 10'000, 1000), 10'000u);  // 64 ms
    EXPECT_EQ(affordable(100, 1, 1000), 1u);
    EXPECT_EQ(affordable(100, 64, 1000), 64u);
    EXPECT_EQ(affordable(100, 3, 1e-9), 3u);  // fewer than the least
}

TEST(AffordableTiles, AreThoseWithinTheBudgetForWhoIsSlow) {
    const double ms_a_tile = 1000 * rays_a_tile * 1e-6;
    EXPECT_NEAR(static_cast<double>(affordable(1000, 100'000, 1000)), 1000 / ms_a_tile, 1);
    EXPECT_NEAR(static_cast<double>(affordable(1000, 100'000, 10)), 10 / ms_a_tile, 1);
    EXPECT_EQ(affordable(1e9, 100'000, 1000), 4u);  // the least
}

LineUp two_backends(double ns_of_second, std::vector<std::string>& log) {
    LineUp line_up;
    line_up.push_back(std::make_unique<FakeBackend>("a", 100, log));
    line_up.push_back(std::make_unique<FakeBackend>("b", ns_of_second, log));
    return line_up;
}

TEST(MeasureTraces, BackendsTakeTurns) {
    std::vector<std::string> log;
    LineUp line_up = two_backends(1e6, log);
    std::size_t steps = 0;
    const RayBatch rays = batch_of(100);
    const std::vector<TraceRounds> results =
        measure_traces(line_up, rays, {.rounds = 3, .max_ms = 640}, [&] { ++steps; });
    EXPECT_EQ(steps, 2u * 4);
    EXPECT_EQ(std::vector(log.end() - 6, log.end()), (std::vector<std::string>{"a", "b", "a", "b", "a", "b"}));
    EXPECT_EQ(results[0].n, 100u * rays_a_tile);
    EXPECT_EQ(results[1].n, 10u * rays_a_tile);  // 64 ms a tile
    EXPECT_TRUE(results[0].hash.has_value());
    EXPECT_FALSE(results[1].hash.has_value());
    EXPECT_FALSE(results[0].soundness.has_value());
    ASSERT_EQ(results[1].ns_per_ray.size(), 3u);
    for (const double ns : results[1].ns_per_ray) EXPECT_DOUBLE_EQ(ns, 1e6);  // a ray, not the set
}

TEST(MeasureBuilds, TheFirstDoesNotCount) {
    std::vector<std::string> log;
    LineUp line_up = two_backends(100, log);
    const std::vector<BuildRounds> results = measure_builds(line_up, {}, 2, [] {});
    EXPECT_EQ(log, (std::vector<std::string>{"build a", "build b", "build a", "build b", "build a", "build b"}));
    EXPECT_EQ(results[0].ms, (std::vector<double>{3, 5}));
    EXPECT_EQ(results[1].ms, (std::vector<double>{4, 6}));
    EXPECT_EQ(results[1].last.ms, 6);
    EXPECT_TRUE(measure_builds(line_up, {}, 0, [] {})[0].ms.empty());
}

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
