// SPDX-License-Identifier: MIT
#include "validation/leaks/inside_rays.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

double nearest_vertex(const Soup& soup, const Ray& ray) {
    double nearest = INFINITY;
    for (const vec3& position : soup.positions) nearest = std::min(nearest, distance_to_line(position, ray));
    return nearest;
}

class InsideRaysTest : public ::testing::Test {
  protected:
    const Soup soup_ = sphere(2);
    const ClosedMesh closed_{soup_.view()};
};

TEST_F(InsideRaysTest, StartInsideAndPassTheirTargets) {
    std::size_t at_vertices = 0;
    const std::vector<Ray> both = InsideRays(closed_, Aim::both, 3).rays(0, 400);
    for (std::size_t i = 0; i < both.size(); ++i) {
        ASSERT_TRUE(is_traceable(both[i]));
        EXPECT_LT(length(both[i].origin), 1.0f);
        const bool at_vertex = nearest_vertex(soup_, both[i]) < 1e-6;
        EXPECT_TRUE(at_vertex || i % 2 == 1) << i;
        at_vertices += at_vertex;
    }
    EXPECT_LT(at_vertices, 210u) << "points of edges are not vertices";
    for (const Ray& ray : InsideRays(closed_, Aim::vertices, 3).rays(0, 100))
        EXPECT_LT(nearest_vertex(soup_, ray), 1e-6);
}

TEST_F(InsideRaysTest, RayIDependsOnSeedAndIndexAlone) {
    const InsideRays rays(closed_, Aim::both, 3), other(closed_, Aim::both, 4);
    const std::vector<Ray> all = rays.rays(0, 1000), tail = rays.rays(990, 10);
    for (std::size_t i = 0; i < tail.size(); ++i) {
        EXPECT_EQ(std::memcmp(&tail[i], &all[990 + i], sizeof(Ray)), 0) << i;
        const Ray of_other = other.ray(990 + i);
        EXPECT_NE(std::memcmp(&tail[i], &of_other, sizeof(Ray)), 0) << i;
    }
}

TEST_F(InsideRaysTest, EvenCountsAreLeaksOrDoubleHits) {
    for (const Ray& ray : InsideRays(closed_, Aim::both, 3).rays(0, 200)) {
        EXPECT_EQ(check_crossings(closed_, ray, 1), Parity::odd);
        EXPECT_EQ(check_crossings(closed_, ray, 0), Parity::leak);
        EXPECT_EQ(check_crossings(closed_, ray, 2), Parity::double_hit);
        EXPECT_EQ(check_crossings(closed_, ray, 3), Parity::odd);  // what parity cannot see
    }
}

TEST(InsideRays, ATriangleSeenEdgeOnAtTheOriginDecidesNothing) {
    const Soup soup = cube();
    const ClosedMesh closed(soup.view());
    const vec3 direction(0.6f, 0.8f, 0);
    EXPECT_EQ(check_crossings(closed, make_ray({0.5f, 0.4f, 1e-8f}, direction), 2), Parity::unspecified);
    EXPECT_EQ(check_crossings(closed, make_ray({0.5f, 0.4f, 1e-3f}, direction), 2), Parity::double_hit);
}

}  // namespace
}  // namespace twinray
