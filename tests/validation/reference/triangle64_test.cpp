// SPDX-License-Identifier: MIT
#include "validation/reference/triangle64.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace twinray {
namespace {

TEST(HasArea, IsDecidedExactly) {
    const float ulp = std::numeric_limits<float>::epsilon();
    EXPECT_FALSE(has_area({vec3(1, 1, 1), vec3(3, 3, 3), vec3(1e6f, 1e6f, 1e6f)}));
    EXPECT_TRUE(has_area({vec3(1, 1, 1), vec3(3, 3, 3), vec3(1e6f, 1e6f, 1e6f + 0.0625f)}));
    EXPECT_TRUE(has_area({vec3(1, 1, 0), vec3(1 + ulp, 1 + ulp, 0), vec3(1e30f, 1e30f * (1 + ulp), 0)}));
    EXPECT_FALSE(has_area({vec3(1e-30f), vec3(1), vec3(1e30f)}));
    // The area is 2^-40 and its terms are 2^20: a float64 sum would lose it.
    EXPECT_TRUE(has_area({vec3(0, 1, 0), vec3(0x1p-60f, 1, 0), vec3(0x1p20f, 0x1p20f + 1, 0)}));
    EXPECT_TRUE(has_area({vec3(0), vec3(1e-40f, 0, 0), vec3(0, 1e-40f, 0)}));
    EXPECT_TRUE(has_area({vec3(0), vec3(3e38f, 0, 0), vec3(0, 3e38f, 0)}));
}

TEST(HasArea, IsFalseForNonFiniteVertices) {
    EXPECT_FALSE(has_area({vec3(0), vec3(1, 0, 0), vec3(0, 1, NAN)}));
    EXPECT_FALSE(has_area({vec3(0), vec3(1, 0, 0), vec3(0, INFINITY, 0)}));
}

TEST(ShearedRay, FindsTUAndVOfASkewedTriangle) {
    const ShearedRay ray({0.25, 0.5, -1}, {0, 0, 0.5});
    const auto hit = ray.intersect({dvec3(0, 0, 1), dvec3(1, 0, 2), dvec3(0, 1, 3)});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->u, 0.25);
    EXPECT_EQ(hit->v, 0.5);
    EXPECT_EQ(hit->t, 2 * (1 + 0.25 * 1 + 0.5 * 2 + 1));
}

TEST(ShearedRay, CountsEdgesAndVerticesAsInsideInEitherWinding) {
    const Triangle64 triangle = {dvec3(0, 0, 1), dvec3(1, 0, 1), dvec3(0, 1, 1)};
    const Triangle64 flipped = {triangle[1], triangle[0], triangle[2]};
    for (const dvec2 point : {dvec2(0, 0), dvec2(1, 0), dvec2(0.5, 0.5), dvec2(0.25, 0)}) {
        const ShearedRay ray({point, 0}, {0, 0, 1});
        EXPECT_TRUE(ray.intersect(triangle)) << point.x << " " << point.y;
        EXPECT_TRUE(ray.intersect(flipped)) << point.x << " " << point.y;
    }
    EXPECT_FALSE(ShearedRay({0.5, 0.5 + 1e-15, 0}, {0, 0, 1}).intersect(triangle));
}

TEST(ShearedRay, MissesATriangleSeenEdgeOn) {
    const ShearedRay ray({0.25, 0.25, 0}, {0, 0, 1});
    EXPECT_FALSE(ray.intersect({dvec3(0, 0.25, 1), dvec3(1, 0.25, 1), dvec3(0, 0.25, 2)}));
}

}  // namespace
}  // namespace twinray
