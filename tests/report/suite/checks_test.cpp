// Judgements of answers to rays and of pictures.
#include "report/suite/checks.h"

#include <gtest/gtest.h>

#include <cmath>

#include <twinray/geometry.h>
#include "report/suite/pictures.h"

namespace twinray::suite {
namespace {

class Checking : public ::testing::Test {
  protected:
    Mesh square_ = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    MeshView view_ = square_;
    ReferenceInstance instance_{0, {}};
    ReferenceScene reference_{std::span(&view_, 1), std::span(&instance_, 1)};
    // One ray hits the square, one passes it, and nobody may trace the third.
    std::vector<Ray> rays_ = {{vec3(0.3f, 0.2f, 3), 0, vec3(0, 0, -1), INFINITY},
                              {vec3(5, 5, 3), 0, vec3(0, 0, -1), INFINITY},
                              {vec3(0.3f, 0.2f, 3), 0, vec3(0), INFINITY}};

    Hit hit(float t) const {
        const ReferenceHit exact = reference_.closest_hit(rays_[0]);
        Hit hit = miss();
        hit.hit = 1;
        hit.t = t;
        hit.primitive_index = exact.primitive;
        hit.u = static_cast<float>(exact.u);
        hit.v = static_cast<float>(exact.v);
        return hit;
    }
    CheckResult checked(const std::vector<Hit>& hits, Backend backend) {
        return check(reference_, rays_, hits, backend);
    }
};

TEST_F(Checking, RightAnswersHaveNoFault) {
    const CheckResult right = checked({hit(3), miss(), miss()}, Backend::software);
    EXPECT_EQ(right.faults, 0u);
    EXPECT_EQ(right.classes[HitClass::agree], 3u);
    Record record;
    set_check_result(record, right);
    EXPECT_EQ(record.n, 3u);
    EXPECT_EQ(record.counts, (std::map<std::string, std::uint64_t>{{"AGREE", 3}}));
    EXPECT_EQ(record.bound95, upper_bound_95(0, 3));
}

TEST_F(Checking, FaultsAreCountedAndTheFirstIsShown) {
    const CheckResult ours = checked({miss(), hit(3), hit(3)}, Backend::software);
    EXPECT_EQ(ours.classes[HitClass::sw_leak], 1u);
    EXPECT_EQ(ours.classes[HitClass::sw_false], 1u);
    EXPECT_EQ(ours.classes[HitClass::invalid_input], 1u);
    EXPECT_EQ(ours.faults, 3u);
    EXPECT_EQ(ours.example, "SW_LEAK " + hexadecimal(rays_[0]));
    const CheckResult drivers = checked({miss(), miss(), miss()}, Backend::pipeline);
    EXPECT_EQ(drivers.classes[HitClass::hw_leak], 1u);
    EXPECT_EQ(drivers.faults, 1u);
}

TEST_F(Checking, AnExampleIsTheRayToTheLastBit) {
    EXPECT_EQ(hexadecimal({vec3(1, -0.5f, 0), 0, vec3(0x1.000002p0f, 0, -1), INFINITY}),
              "0x1p+0 -0x1p-1 0x0p+0 0x0p+0 0x1.000002p+0 0x0p+0 -0x1p+0 inf");
}

TEST_F(Checking, ErrorOfTIsInUnitsOfItsLastPlace) {
    const std::vector<ReferenceHit> references = references_of(reference_, rays_);
    const std::optional<ErrorFigures> error =
        t_error(references, std::vector<Hit>{hit(3 + 4 * 0x1p-22f), miss(), miss()});
    ASSERT_TRUE(error);
    EXPECT_EQ(error->max, 4);
    EXPECT_EQ(error->median, 4);
    EXPECT_FALSE(t_error(references, std::vector<Hit>{miss(), miss(), miss()}));
}

HdrImage plain(vec3 color) { return {16, 16, std::vector<vec3>(256, color)}; }

TEST(Flip, OfAPictureToItselfIsNothing) {
    HdrImage picture = plain(vec3(0.5f));
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) picture.rgb[i] = vec3(1, 0.2f, 0);
    for (const double difference : flip(picture, picture)) EXPECT_EQ(difference, 0);
}

// Lightness differs by 100; green and blue differ the most, by 203.1: ((100 / 203.1)^0.7 - 0.4) / 0.6 of the last
// twentieth.
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

// The eye does not resolve a checkerboard of pixels 67 to a degree, but does resolve one from nearby.
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
