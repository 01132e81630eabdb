// SPDX-License-Identifier: MIT
#include "engine/analysis/pair_plan.h"

#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "tests/analysis/plain_scenes.h"

namespace twinray {
namespace {

std::vector<std::vector<uint>> each_face(const FacePolygons& polygons) {
    std::vector<std::vector<uint>> members(polygons.faces.size());
    for (uint i = 0; i < members.size(); ++i)
        if (polygons.faces[i].count) members[i] = {i};
    return members;
}

PairPlan plan_of(const Scene& scene, const PairPlanOptions& options = {}) {
    const FacePolygons polygons(scene);
    return plan_pairs(polygons, each_face(polygons), options);
}

std::string refusal_of(const Scene& scene, PairEstimator estimator) {
    try {
        plan_of(scene, {.estimator = estimator});
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

// Makes squares with sides of 1 at a distance, and a smaller one half way between.
Scene plate_between(float distance) {
    return test::scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                           make_quad(vec3(0, 0, distance), vec3(0, 1, 0), vec3(1, 0, 0)),
                           make_quad(vec3(0.2f, 0.2f, distance / 2), vec3(0, 0.6f, 0), vec3(0.6f, 0, 0))});
}

TEST(PairPlan, ContoursTellAllOfAConvexRoom) {
    Scene room = test::scene_of({make_box(vec3(-1, -2, -3), vec3(1, 0, 5))});
    for (uvec3& triangle : room.meshes[0].triangles) std::swap(triangle.y, triangle.z);  // seen from inside
    room.instances[0].transform = Transform::scaling(vec3(-1, 1, 1));                    // still, in a mirror
    const PairPlan plan = plan_of(room);
    EXPECT_EQ(plan.left_to_hits, 0u);
    ASSERT_EQ(plan.pairs.size(), 12u * 10 / 2);
    double total = 0;
    for (const PlannedPair& pair : plan.pairs) {
        EXPECT_TRUE(pair.sampled.empty());
        EXPECT_LT(pair.i, pair.j);
        total += 2 * pair.contour.flow;
    }
    EXPECT_NEAR(total, 2 * (2 * 2 + 2 * 8 + 2 * 8), 1e-12 * total) << "all that the walls radiate meets walls";
}

TEST(PairPlan, WhatIsFarAwayDoesNotMakeOthersTouch) {
    const Scene scene = test::scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                                        make_quad(vec3(0, 0, 1e-6f), vec3(0, 1, 0), vec3(1, 0, 0)),
                                        make_quad(vec3(1e9f, 0, 9), vec3(1e9f, 0, 0), vec3(0, 1e9f, 0))});
    const PairPlan plan = plan_pairs(FacePolygons(scene), std::vector<std::vector<uint>>{{0, 1}, {2, 3}, {4, 5}}, {});
    ASSERT_FALSE(plan.pairs.empty());
    EXPECT_EQ(plan.pairs[0].j, 1u);
    EXPECT_NEAR(plan.pairs[0].contour.flow, 0.9999980000100295, 1e-12);
}

TEST(PairPlan, WhatMayBeBlockedIsLeftToAreasOrHitsByItsGap) {
    for (const float distance : {2.0f, 0.1f}) {
        const PairPlan plan = plan_of(plate_between(distance));
        for (const PlannedPair& pair : plan.pairs) {
            const bool is_between_squares = pair.i < 2 && pair.j >= 2 && pair.j < 4;
            EXPECT_EQ(pair.sampled.empty(), !is_between_squares) << pair.i << ' ' << pair.j;
            for (const SampledPair& sampled : pair.sampled) EXPECT_TRUE(sampled.may_be_blocked);
        }
        EXPECT_EQ(plan.left_to_hits, distance < 1 ? 4u : 0u);
    }
}

// Makes a triangle, another that it sees only by a corner of `height` above its plane, and a square between them.
Scene corner_behind_plate(float height) {
    Mesh seen, corner;
    seen.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
    corner.positions = {vec3(1.5f, 0, height), vec3(1.5f, 1, height - 1), vec3(1.5f, 0, height - 1)};
    seen.triangles = corner.triangles = {{0, 1, 2}};
    return test::scene_of({seen, corner, make_quad(vec3(1.2f, -1, -1), vec3(0, 2, 0), vec3(0, 0, 2))});
}

TEST(PairPlan, AreasAreSampledWhereTheyLieBeforeTheOthersPlane) {
    const SampledPair sampled =
        plan_of(corner_behind_plate(0.25f), {.estimator = PairEstimator::area}).pairs.at(0).sampled.at(0);
    EXPECT_NEAR(sampled.fraction, 1.0 / 16, 1e-6);
    EXPECT_EQ(sampled.part_a.corners[1], vec2(1, 0));
    EXPECT_EQ(sampled.part_a.first, 1);
    EXPECT_NEAR(std::abs(sampled.part_b.corners[1].x), 0.25, 1e-6);
    EXPECT_NEAR(sampled.part_b.corners[1].y, 0, 1e-6);
    for (const vec2& u : {vec2(0.1f, 0.2f), vec2(0.7f, 0.9f), vec2(0.99f, 0.01f)}) {
        const vec2 at = sample_part(sampled.part_b, u);
        EXPECT_GE(at.x, 0);
        EXPECT_GE(at.y, 0);
        EXPECT_LE(at.x + at.y, 0.25f + 1e-6f) << "of the corner above the plane";
    }
}

TEST(PairPlan, OfCornersThatFloat32DoesNotHoldOnlyTheBoundIsTold) {
    const PairPlan plan = plan_of(corner_behind_plate(1e-4f), {.estimator = PairEstimator::area});
    const PlannedPair& pair = plan.pairs.at(0);
    EXPECT_TRUE(pair.sampled.empty());
    EXPECT_GT(pair.contour.flow, 0);
    EXPECT_EQ(pair.contour.flow, pair.contour.error) << "from none to all of it";
}

TEST(PairPlan, BothSidesAreSeenByHalf) {
    const Scene scene = test::scene_of(
        {make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)), make_quad(vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0))});
    const FacePolygons polygons(scene);
    const std::vector<std::vector<uint>> meshes = {{0, 1}, {2, 3}};
    EXPECT_TRUE(plan_pairs(polygons, meshes, {}).pairs.empty()) << "the upper one looks away";
    const PairPlan plan = plan_pairs(polygons, meshes, {.sides = Sides::both});
    ASSERT_EQ(plan.pairs.size(), 1u);
    EXPECT_NEAR(plan.pairs[0].contour.flow, 0.199824895698387383 / 2, 1e-15);
}

TEST(PairPlan, AreasThatNeedMoreRaysThanARowHasAreLeftToHits) {
    const Scene scene = plate_between(2);
    const FacePolygons polygons(scene);
    const std::vector<std::vector<uint>> meshes = {{0, 1}, {2, 3}, {4, 5}};
    EXPECT_EQ(plan_pairs(polygons, meshes, {.rays = 256}).left_to_hits, 0u);
    EXPECT_EQ(plan_pairs(polygons, meshes, {.rays = 255}).left_to_hits, 1u);
}

TEST(PairPlan, AnEstimatorThatDoesNotFitIsRefused) {
    EXPECT_NE(refusal_of(plate_between(2), PairEstimator::contour).find("face 4 may come between faces 0 and 2"),
              std::string::npos);
    EXPECT_EQ(refusal_of(plate_between(2), PairEstimator::area), "");
    EXPECT_NE(refusal_of(plate_between(0.05f), PairEstimator::area).find("the gap between faces 0 and 2 is 0.035"),
              std::string::npos);
    const Scene many = test::scene_of({make_icosphere(3)});
    EXPECT_NE(refusal_of(many, PairEstimator::automatic).find("1280 faces"), std::string::npos);
}

TEST(PairPlan, FacesWithoutAreaHaveNoPairs) {
    Scene scene = plate_between(2);
    scene.meshes[2].positions[0].x = NAN;
    scene.meshes[2].triangles.clear();
    scene.meshes[2].triangles = {uvec3(0, 1, 2), uvec3(1, 1, 2)};
    const PairPlan plan = plan_of(scene, {.estimator = PairEstimator::contour});
    EXPECT_EQ(plan.pairs.size(), 4u) << "nothing is between the squares";
}

}  // namespace
}  // namespace twinray
