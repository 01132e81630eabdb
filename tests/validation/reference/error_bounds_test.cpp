// SPDX-License-Identifier: MIT
#include "validation/reference/error_bounds.h"

#include <gtest/gtest.h>

#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

constexpr double e16 = 16 * 0x1p-24;
const Ray along_z = make_ray(vec3(0), {0, 0, 2});

TriangleBound bound(const Triangle64& triangle, const Transform& transform = {},
                    Accelerator accelerator = Accelerator::software) {
    return ErrorBounds(along_z, Placement64(transform, "test"), accelerator).bound(triangle);
}

const Triangle64 facing = {dvec3(-3, -3, 4), dvec3(3, -3, 4), dvec3(0, 3, 4)};

TEST(ErrorBounds, BoundOfAFacingTriangle) {
    const TriangleBound seen = bound(facing);
    EXPECT_DOUBLE_EQ(seen.radius, e16 * std::sqrt(34.0));
    EXPECT_NEAR(seen.margin, 3 / std::sqrt(5.0), 1e-12);  // to the slanted sides
    EXPECT_DOUBLE_EQ(seen.t, 2);
    EXPECT_NEAR(seen.t_low, 2 - seen.radius / 2, 1e-12);
    EXPECT_NEAR(seen.t_high, 2 + seen.radius / 2, 1e-12);
    EXPECT_NEAR(seen.distance_to(0.25, 0.5), 0, 1e-12);
    EXPECT_NEAR(seen.distance_to(1, 0), std::sqrt(18.0), 1e-12);
}

TEST(ErrorBounds, MarginIsNegativeOutsideAndEdgeOn) {
    EXPECT_NEAR(bound({dvec3(1, -3, 4), dvec3(3, -3, 4), dvec3(1, 3, 4)}).margin, -1, 1e-12);
    EXPECT_NEAR(bound({dvec3(2, -1, 4), dvec3(2, 1, 4), dvec3(2, 0, 9)}).margin, -2, 1e-12);
    EXPECT_EQ(bound({dvec3(0, -1, 4), dvec3(0, 1, 4), dvec3(0, 0, 9)}).margin, 0);
}

TEST(ErrorBounds, SteepTrianglesHaveWiderBoundsThatEndAtTheirVertices) {
    const TriangleBound steep = bound({dvec3(-1, -1, 0), dvec3(-1, 1, 0), dvec3(1, 0, 2000)});
    EXPECT_GT(steep.t_high - steep.t_low, 500 * 2 * steep.radius);
    EXPECT_LT(steep.t_high - steep.t_low, 100);
    for (const double width : {0.0, 1e-7}) {  // within the radius: rounding chooses the point
        const TriangleBound sliver = bound({dvec3(-1, -width, 4), dvec3(1, -width, 8), dvec3(0, width, 6)});
        EXPECT_NEAR(sliver.t_low, 2, 1e-5) << width;
        EXPECT_NEAR(sliver.t_high, 4, 1e-5) << width;
        EXPECT_EQ(sliver.point_error, INFINITY) << width;
    }
}

TEST(ErrorBounds, TransformsAddTheErrorOfOriginAndDirection) {
    // The inverse maps (0, 0, 2) to (-200, 0, 2): a rounding of its entry 100 displaces the ray in proportion to t.
    const Transform sheared = {{vec4(1, 0, 100, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)}};
    const TriangleBound near = bound(facing, sheared);
    Triangle64 moved = facing;
    for (dvec3& vertex : moved) vertex += dvec3(-1e6, 0, 1e4);
    const TriangleBound far = bound(moved, sheared);
    EXPECT_NEAR(near.radius / bound(facing).radius, 2, 1e-3);  // |W||d| = |W d| here
    EXPECT_NEAR(far.radius / bound(moved).radius, 2, 1e-3);

    const TriangleBound shifted = bound(facing, Transform::translation({0, 0, 1000}));
    EXPECT_NEAR(shifted.radius, e16 * 2000, e16 * 1100);
    EXPECT_GT(bound(facing, sheared, Accelerator::hardware).radius, 100 * near.radius);  // condition 201
}

TEST(ErrorBounds, NoTriangleInABoxExceedsItsMaxRadius) {
    std::mt19937 random(5);
    const ErrorBounds bounds(along_z, Placement64(rotation(0.5f, 0.3f), "test"), Accelerator::hardware);
    for (int i = 0; i < 1000; ++i) {
        Box64 box;
        Triangle64 triangle;
        for (dvec3& vertex : triangle) box.include(vertex = dvec3(uniform3(random, -9, 9)));
        ASSERT_LE(bounds.bound(triangle).radius, bounds.max_radius(box)) << "seed 5";
    }
}

}  // namespace
}  // namespace twinray
