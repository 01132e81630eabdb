// SPDX-License-Identifier: MIT
#include "bench/tiles.h"

#include <gtest/gtest.h>

namespace twinray::bench {
namespace {

// Ray i has t_max i.
std::vector<Ray> numbered(std::size_t count) {
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) rays[i].t_max = static_cast<float>(i);
    return rays;
}

// The numbers of the tiles; a failure unless each is whole.
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

}  // namespace
}  // namespace twinray::bench
