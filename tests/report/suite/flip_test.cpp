// SPDX-License-Identifier: MIT
#include "report/suite/flip.h"

#include <gtest/gtest.h>

namespace twinray::suite {
namespace {

HdrImage plain(vec3 color) { return {16, 16, std::vector<vec3>(256, color)}; }

TEST(Flip, OfAPictureToItselfIsNothing) {
    HdrImage picture = plain(vec3(0.5f));
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) picture.rgb[i] = vec3(1, 0.2f, 0);
    for (const double difference : flip(picture, picture)) EXPECT_EQ(difference, 0);
}

// Lightness differs by 100; of green and blue, the most that there is, by 203.1: ((100 / 203.1)^0.7 - 0.4) / 0.6 of the
// last twentieth.
TEST(Flip, OfBlackAndWhiteIsNearlyOne) {
    EXPECT_NEAR(mean_flip(plain(vec3(0)), plain(vec3(1))), 0.95 + 0.05 * (std::pow(100 / 203.1, 0.7) - 0.4) / 0.6,
                1e-3);
    EXPECT_NEAR(mean_flip(plain({0, 1, 0}), plain({0, 0, 1})), 1, 1e-6);
}

TEST(Flip, IsSymmetricAndGrowsWithTheDifference) {
    EXPECT_NEAR(mean_flip(plain(vec3(0.2f)), plain(vec3(0.3f))), mean_flip(plain(vec3(0.3f)), plain(vec3(0.2f))),
                1e-12);
    EXPECT_LT(mean_flip(plain(vec3(0.2f)), plain(vec3(0.3f))), mean_flip(plain(vec3(0.2f)), plain(vec3(0.5f))));
}

// The eye does not resolve a checkerboard of pixels 67 to a degree, but one seen from nearby.
TEST(Flip, FineGrainIsSeenFromNearbyAlone) {
    HdrImage board = plain(vec3(0.5f));
    for (uint y = 0; y < 16; ++y)
        for (uint x = 0; x < 16; ++x) board.rgb[y * 16 + x] = vec3((x + y) % 2 ? 0.6f : 0.4f);
    const HdrImage grey = plain(vec3(0.5f));
    EXPECT_LT(flip(board, grey, 67)[8 * 16 + 8], 0.1);
    EXPECT_GT(flip(board, grey, 5)[8 * 16 + 8], 0.15);
}

TEST(Flip, AnEdgeWeighsMoreThanItsColorAlone) {
    HdrImage edge = plain(vec3(0.3f));
    for (uint y = 0; y < 16; ++y)
        for (uint x = 8; x < 16; ++x) edge.rgb[y * 16 + x] = vec3(0.4f);
    const std::vector<double> all = flip(edge, plain(vec3(0.3f)));
    EXPECT_GT(all[8 * 16 + 9], all[8 * 16 + 15]);
}

}  // namespace
}  // namespace twinray::suite
