// SPDX-License-Identifier: MIT
// Backends are measured in turns, over as many tiles of the rays as the time allows.
#include "bench/measure.h"

#include <gtest/gtest.h>

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

TEST(MeasureTraces, BackendsTakeTurns) {
    std::vector<std::string> log;
    LineUp line_up;
    line_up.push_back(std::make_unique<FakeBackend>("a", 100, log));
    line_up.push_back(std::make_unique<FakeBackend>("b", 1e6, log));
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
    LineUp line_up;
    line_up.push_back(std::make_unique<FakeBackend>("a", 100, log));
    line_up.push_back(std::make_unique<FakeBackend>("b", 100, log));
    const std::vector<BuildRounds> results = measure_builds(line_up, {}, 2, [] {});
    EXPECT_EQ(log, (std::vector<std::string>{"build a", "build b", "build a", "build b", "build a", "build b"}));
    EXPECT_EQ(results[0].ms, (std::vector<double>{3, 5}));
    EXPECT_EQ(results[1].ms, (std::vector<double>{4, 6}));
    EXPECT_EQ(results[1].last.ms, 6);
    EXPECT_TRUE(measure_builds(line_up, {}, 0, [] {})[0].ms.empty());
}

}  // namespace
}  // namespace twinray::bench
