// SPDX-License-Identifier: MIT
#include <twinray/analysis.h>

#include "engine/analysis/faces.h"
#include "tests/analysis/scenes.h"

namespace twinray::test {
namespace {

class CentroidTest : public AnalysisTest {
  protected:
    Centroid seen(const Scene& scene, const CentroidDesc& desc) {
        fill(scene);
        return centroid(accel(), scene, desc);
    }
};
TWINRAY_OVER_EVERY_ACCEL(CentroidTest);

// Results that do not depend on the accelerator.
class CentroidRulesTest : public CentroidTest {};
TWINRAY_OVER_SOFTWARE(CentroidRulesTest);

CentroidDesc centroids_along(dvec3 direction, uint side) { return {.grid = {.direction = direction, .side = side}}; }

void expect_near(dvec3 a, dvec3 b, dvec3 error) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], error[axis]) << axis;
}

TEST_P(CentroidTest, OfASquareIsItsMiddleInWorldSpace) {
    for (const Transform& transform : {Transform(), skewed(), mirrored()}) {
        const Scene scene = scene_of({square(2)}, {transform});
        const Centroid result = seen(scene, centroids_along({0.5, 0.25, -1}, 100));
        ASSERT_TRUE(result.mean && result.standard_error);
        EXPECT_EQ(result.ray_count, 10000u);
        EXPECT_GT(result.point_count, 2000u);
        expect_near(*result.mean, in_world(transform, vec3(0.5f, 0.5f, 2)), *result.standard_error * 4.0 + 1e-6);
        expect_near(*result.standard_error, dvec3(0), dvec3(0.01));
    }
}

TEST_P(CentroidRulesTest, OfASphereIsTwoThirdsOfTheRadiusInFront) {
    const Scene scene = scene_of({make_icosphere(5, 3)}, {Transform::translation({100, -200, 300})});
    const Centroid result = seen(scene, centroids_along({0, 1e-3, 0}, 300));
    ASSERT_TRUE(result.mean);
    expect_near(*result.mean, {100, -202, 300}, *result.standard_error * 4.0 + 0.004);  // facets
}

TEST_P(CentroidRulesTest, OnlyTheClosestPointsCount) {
    const Scene scene = scene_of({square(0), square(1), make_quad(vec3(0, 0, -1), vec3(0.5f, 0, 0), vec3(0, 1, 0))});
    EXPECT_NEAR(seen(scene, centroids_along({0, 0, -1}, 50)).mean->z, 1, 1e-6);
    EXPECT_NEAR(seen(scene, centroids_along({0, 0, 1}, 50)).mean->z, -0.5, 0.02);
}

TEST_P(CentroidRulesTest, StandardErrorsAreThoseOfManySeeds) {
    const Scene scene = scene_of({make_icosphere(2)}, {skewed()});
    fill(scene);
    constexpr int runs = 100;
    dvec3 sum(0), squares(0), told(0);
    const dvec3 about = *centroid(accel(), scene, centroids_along({1, 2, -3}, 400)).mean;
    for (int run = 0; run < runs; ++run) {
        CentroidDesc desc = centroids_along({1, 2, -3}, 40);
        desc.grid.seed = 77 + run;
        const Centroid result = centroid(accel(), scene, desc);
        const dvec3 off = *result.mean - about;
        sum += off, squares += off * off, told += *result.standard_error / double{runs};
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double spread = std::sqrt(squares[axis] / runs);
        EXPECT_GT(told[axis], spread * 0.8) << axis;
        EXPECT_LT(told[axis], spread * 2) << axis;
        EXPECT_LT(std::abs(sum[axis] / runs), spread * 0.4) << axis;
    }
}

TEST_P(CentroidRulesTest, PointsAreKeptWhereAskedAndMeanWhatTheySay) {
    CentroidDesc desc = centroids_along({0, -1, 0}, 1025);  // more than one batch
    desc.keeps_points = true;
    const Scene scene = scene_of({make_icosphere(1)}, {Transform::translation({0, 7, 0})});
    const Centroid result = seen(scene, desc);
    ASSERT_EQ(result.points.size(), result.point_count);
    dvec3 sum(0);
    for (const dvec3& point : result.points) {
        EXPECT_GT(point.y, 6.999);
        EXPECT_LT(length(point - dvec3(0, 7, 0)), 1.000001);
        sum += point;
    }
    expect_near(sum / double(result.points.size()), *result.mean, dvec3(1e-9));
    const Centroid again = seen(scene, centroids_along({0, -1, 0}, 1025));
    EXPECT_TRUE(again.points.empty());
    EXPECT_EQ(*again.mean, *result.mean);
    EXPECT_EQ(*again.standard_error, *result.standard_error);
}

TEST_P(CentroidRulesTest, CentersGiveAMeanForEverySeedAndNoError) {
    CentroidDesc desc = centroids_along({0, 0, -1}, 32);
    desc.grid.points = GridPoints::centers;
    const Centroid result = seen(scene_of({square(0)}), desc);
    expect_near(*result.mean, {0.5, 0.5, 0}, dvec3(1e-6));
    EXPECT_FALSE(result.standard_error);
    desc.grid.seed = 5;
    EXPECT_EQ(*seen(scene_of({square(0)}), desc).mean, *result.mean);
}

TEST_P(CentroidRulesTest, NothingHitIsNoMean) {
    for (const Scene& scene : {Scene(), scene_of({Mesh()}), scene_of({make_quad(vec3(1), vec3(0), vec3(0))})}) {
        const Centroid result = seen(scene, centroids_along({0, 0, -1}, 10));
        EXPECT_FALSE(result.mean || result.standard_error);
        EXPECT_EQ(result.point_count, 0u);
    }
}

TEST_P(CentroidRulesTest, WrongUseSaysWhatIsWrong) {
    fill(scene_of({make_icosphere(0)}));
    const auto expect_refused = [&](const Scene& scene, const CentroidDesc& desc, const char* why) {
        expect_contains(error_of([&] { centroid(accel(), scene, desc); }), why);
    };
    expect_refused(scene_of({square(0)}), centroids_along({0, 0, -1}, 9),
                   "its instance 0 has 20 primitives and the scene's 2 triangles");
    expect_refused(Scene(), centroids_along({0, 0, -1}, 9), "has 1 instances");
    expect_refused(scene_of({make_icosphere(0)}), centroids_along({0, INFINITY, -1}, 9), "finite");
    const Scene vast = scene_of({make_quad(vec3(-3.4e38f, 0, 0), vec3(3.4e38f, 0, 0), vec3(0, 3e38f, 0))});
    fill(vast);
    expect_refused(vast, centroids_along({1, 0, 0.1}, 9), "float32 ends");
}

}  // namespace
}  // namespace twinray::test
