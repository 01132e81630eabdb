// SPDX-License-Identifier: MIT
#include "engine/verify/tube.h"

#include <gtest/gtest.h>

#include "tests/verify/meshes.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

constexpr double e16 = 16 * 0x1p-24;
const Ray along_z = make_ray(vec3(0), {0, 0, 2});

Footprint footprint(const Triangle64& triangle, const Transform& transform = {},
                    Accelerator accelerator = Accelerator::software) {
    return Tube(along_z, Placement64(transform, "test"), accelerator).footprint(triangle);
}

const Triangle64 facing = {dvec3(-3, -3, 4), dvec3(3, -3, 4), dvec3(0, 3, 4)};

TEST(Tube, FootprintOfAFacingTriangle) {
    const Footprint seen = footprint(facing);
    EXPECT_DOUBLE_EQ(seen.radius, e16 * std::sqrt(34.0));
    EXPECT_NEAR(seen.margin, 3 / std::sqrt(5.0), 1e-12);  // to the slanted sides
    EXPECT_DOUBLE_EQ(seen.t, 2);
    EXPECT_NEAR(seen.t_low, 2 - seen.radius / 2, 1e-12);
    EXPECT_NEAR(seen.t_high, 2 + seen.radius / 2, 1e-12);
    EXPECT_NEAR(seen.distance_to(0.25, 0.5), 0, 1e-12);
    EXPECT_NEAR(seen.distance_to(1, 0), std::sqrt(18.0), 1e-12);
}

TEST(Tube, MarginIsNegativeOutsideAndEdgeOn) {
    EXPECT_NEAR(footprint({dvec3(1, -3, 4), dvec3(3, -3, 4), dvec3(1, 3, 4)}).margin, -1, 1e-12);
    EXPECT_NEAR(footprint({dvec3(2, -1, 4), dvec3(2, 1, 4), dvec3(2, 0, 9)}).margin, -2, 1e-12);
    EXPECT_EQ(footprint({dvec3(0, -1, 4), dvec3(0, 1, 4), dvec3(0, 0, 9)}).margin, 0);
}

TEST(Tube, SteepTrianglesHaveWiderBoundsThatEndAtTheirCorners) {
    const Footprint steep = footprint({dvec3(-1, -1, 0), dvec3(-1, 1, 0), dvec3(1, 0, 2000)});
    EXPECT_GT(steep.t_high - steep.t_low, 500 * 2 * steep.radius);
    EXPECT_LT(steep.t_high - steep.t_low, 100);
    for (const double width : {0.0, 1e-7}) {  // within the radius: rounding chooses the point
        const Footprint sliver = footprint({dvec3(-1, -width, 4), dvec3(1, -width, 8), dvec3(0, width, 6)});
        EXPECT_NEAR(sliver.t_low, 2, 1e-5) << width;
        EXPECT_NEAR(sliver.t_high, 4, 1e-5) << width;
        EXPECT_EQ(sliver.point_error, INFINITY) << width;
    }
}

TEST(Tube, TransformsAddTheErrorOfOriginAndDirection) {
    // The inverse maps (0, 0, 2) to (-200, 0, 2): a rounding of its entry 100 displaces the ray in proportion to t.
    const Transform sheared = {{vec4(1, 0, 100, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)}};
    const Footprint near = footprint(facing, sheared);
    Triangle64 moved = facing;
    for (dvec3& corner : moved) corner += dvec3(-1e6, 0, 1e4);
    const Footprint far = footprint(moved, sheared);
    EXPECT_NEAR(near.radius / footprint(facing).radius, 2, 1e-3);  // |W||d| = |W d| here
    EXPECT_NEAR(far.radius / footprint(moved).radius, 2, 1e-3);

    const Footprint shifted = footprint(facing, Transform::translation({0, 0, 1000}));
    EXPECT_NEAR(shifted.radius, e16 * 2000, e16 * 1100);
    EXPECT_GT(footprint(facing, sheared, Accelerator::hardware).radius, 100 * near.radius);  // condition 201
}

TEST(Tube, NoTriangleInABoxExceedsItsMaxRadius) {
    std::mt19937 random(5);
    const Tube tube(along_z, Placement64(rotation(0.5f, 0.3f), "test"), Accelerator::hardware);
    for (int i = 0; i < 1000; ++i) {
        Box64 box;
        Triangle64 triangle;
        for (dvec3& corner : triangle) box.include(corner = dvec3(uniform3(random, -9, 9)));
        ASSERT_LE(tube.footprint(triangle).radius, tube.max_radius(box)) << "seed 5";
    }
}

}  // namespace
}  // namespace twinray
