// SPDX-License-Identifier: MIT
#include "engine/accel/morton_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace twinray {
namespace {

std::vector<vec3> cube_corners() {
    std::vector<vec3> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i >> 2 & 1, i >> 1 & 1, i & 1);
    return corners;
}

TEST(MortonOrder, OfNothingIsEmpty) { EXPECT_TRUE(morton_order({}).empty()); }

TEST(MortonOrder, VisitsTheCornersOfACubeWithXSlowestAndZFastest) {
    const std::vector<vec3> corners = cube_corners();
    EXPECT_EQ(morton_order(corners), (std::vector<uint>{0, 1, 2, 3, 4, 5, 6, 7}));
    const std::vector<vec3> reversed(corners.rbegin(), corners.rend());
    EXPECT_EQ(morton_order(reversed), (std::vector<uint>{7, 6, 5, 4, 3, 2, 1, 0}));
}

TEST(MortonOrder, KeepsEqualCentersInOrder) {
    EXPECT_EQ(morton_order(std::vector<vec3>(5, vec3(3, -2, 1))), (std::vector<uint>{0, 1, 2, 3, 4}));
}

TEST(MortonOrder, PutsNonFiniteCentersLastInOrder) {
    const std::vector<vec3> centers = {vec3(NAN), vec3(1, 0, 0), vec3(0, INFINITY, 0), vec3(0), vec3(0, 0, -INFINITY)};
    EXPECT_EQ(morton_order(centers), (std::vector<uint>{3, 1, 0, 2, 4}));
    EXPECT_EQ(morton_order(std::vector<vec3>(3, vec3(NAN))), (std::vector<uint>{0, 1, 2}));
}

TEST(MortonOrder, TellsMoreThanAMillionCellsApartOnOneAxis) {
    const float step = 1.0f / (1 << 20);
    const std::vector<vec3> centers = {vec3(0), vec3(step * 5, 0, 0), vec3(step * 4, 0, 0), vec3(1, 0, 0)};
    EXPECT_EQ(morton_order(centers), (std::vector<uint>{0, 2, 1, 3}));
}

TEST(MortonOrder, SurvivesAnExtentBeyondTheLargestFloat) {
    const std::vector<vec3> centers = {vec3(3e38f, 0, 0), vec3(-3e38f, 0, 0), vec3(0)};
    EXPECT_EQ(morton_order(centers), (std::vector<uint>{1, 2, 0}));
}

TEST(MortonOrder, OfRandomPointsIsAPermutationWithShortSteps) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<vec3> centers(20000);
    for (vec3& center : centers) center = vec3(unit(random), unit(random), unit(random));
    const std::vector<uint> order = morton_order(centers);
    std::vector<uint> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    double total = 0, total_before = 0;
    for (uint i = 0; i < order.size(); ++i) {
        ASSERT_EQ(sorted[i], i);
        if (i == 0) continue;
        total += length(centers[order[i]] - centers[order[i - 1]]);
        total_before += length(centers[i] - centers[i - 1]);
    }
    EXPECT_LT(total, 0.1 * total_before);
}

TEST(TriangleCenters, AreThoseOfTheBoxesAndNanForNonFiniteCorners) {
    const std::vector<vec3> positions = {vec3(0), vec3(4, 0, 0), vec3(0, 2, -6), vec3(0, NAN, 0), vec3(INFINITY, 0, 0)};
    const std::vector<uvec3> triangles = {uvec3(0, 1, 2), uvec3(0, 1, 3), uvec3(4, 0, 1), uvec3(1, 1, 1)};
    const std::vector<vec3> centers = triangle_centers(positions, triangles);
    ASSERT_EQ(centers.size(), 4u);
    EXPECT_EQ(centers[0], vec3(2, 1, -3));
    EXPECT_TRUE(std::isnan(centers[1].x) && std::isnan(centers[2].x));
    EXPECT_EQ(centers[3], vec3(4, 0, 0));
}

}  // namespace
}  // namespace twinray
