// SPDX-License-Identifier: MIT
#include "report/conformance/expectation.h"

#include <gtest/gtest.h>

#include "report/conformance/draws.h"
#include "report/conformance/rules.h"
#include "validation/reference/reference_scene.h"

namespace twinray::conformance {
namespace {

// Two triangles of a square at z = 2, counterclockwise seen from above.
SceneInput square() {
    GeometryInput geometry{.positions = {vec3(-1, -1, 2), vec3(1, -1, 2), vec3(1, 1, 2), vec3(-1, 1, 2)},
                           .triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)}};
    return scene_of(geometry);
}
Shot up(float x, float y) { return shot_of({vec3(x, y, 0), 0, vec3(0, 0, 1), INFINITY}); }

TEST(ConformanceExpectation, InsideIsSureAndEdgesAreNot) {
    const Expectation expectation(square());
    const std::vector<Candidate> inside = expectation.candidates(up(0.5f, -0.5f));
    ASSERT_EQ(inside.size(), 1u);
    EXPECT_TRUE(inside[0].is_sure && inside[0].is_opaque && !inside[0].is_front && !inside[0].is_box);
    EXPECT_EQ(inside[0].primitive, 0u);
    EXPECT_NEAR(inside[0].t_low, 2, 1e-5);
    EXPECT_NEAR(inside[0].t_high, 2, 1e-5);
    EXPECT_LE(inside[0].t_low, inside[0].t_high);
    const std::vector<Candidate> edge = expectation.candidates(up(0.5f, 0.5f));
    ASSERT_EQ(edge.size(), 2u) << "both owners";
    EXPECT_FALSE(edge[0].is_sure || edge[1].is_sure);
    EXPECT_TRUE(expectation.candidates(up(1.5f, 0)).empty());
}

TEST(ConformanceExpectation, LimitsAreNotCertain) {
    const Expectation expectation(square());
    Shot shot = up(0.5f, -0.5f);
    shot.ray.t_max = 2;
    ASSERT_EQ(expectation.candidates(shot).size(), 1u);
    EXPECT_FALSE(expectation.candidates(shot)[0].is_sure);
    shot.ray.t_max = 1.9375f;
    EXPECT_TRUE(expectation.candidates(shot).empty());
    shot.ray = {shot.ray.origin, 2.0625f, shot.ray.direction, INFINITY};
    EXPECT_TRUE(expectation.candidates(shot).empty());
}

TEST(ConformanceExpectation, MasksAndFlagsLeaveOut) {
    SceneInput scene = square();
    scene.top.instances[0].mask = 0x0f;
    scene.top.instances[0].flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR;
    const Expectation expectation(scene);
    Shot shot = up(0.5f, -0.5f);
    shot.cull_mask = 0xf0;
    EXPECT_TRUE(expectation.candidates(shot).empty());
    shot.cull_mask = 0x18;
    ASSERT_EQ(expectation.candidates(shot).size(), 1u);
    EXPECT_TRUE(expectation.candidates(shot)[0].is_front) << "turned by the instance";
    shot.flags = ray_culls_front;
    EXPECT_TRUE(expectation.candidates(shot).empty());
}

TEST(ConformanceExpectation, TheFrontIsThatOfTheGeometryAsItIsBuilt) {
    SceneInput scene = square();
    scene.bottoms[0].geometries[0].transform = Transform::scaling(vec3(-1, 1, 1));
    const std::vector<Candidate> found = Expectation(scene).candidates(up(0.5f, 0.25f));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(found[0].is_front) << "mirrored before the build";
    scene.bottoms[0].geometries[0].transform.reset();
    scene.top.instances[0].to_world = Transform::scaling(vec3(-1, 1, 1));
    EXPECT_FALSE(Expectation(scene).candidates(up(0.5f, 0.25f))[0].is_front) << "mirrored by the instance";
}

TEST(ConformanceExpectation, InactiveAndDegenerateTrianglesAreNotThere) {
    SceneInput scene = square();
    scene.bottoms[0].geometries[0].positions[1].x = NAN;
    EXPECT_TRUE(Expectation(scene).candidates(up(0.5f, -0.5f)).empty());
    EXPECT_EQ(Expectation(scene).candidates(up(-0.5f, 0.5f)).size(), 1u);
    scene.top.instances[0].bottom = no_bottom;
    EXPECT_TRUE(Expectation(scene).candidates(up(-0.5f, 0.5f)).empty());
}

TEST(ConformanceExpectation, BoxesAreSureWhereTheRayPassesThem) {
    SceneInput scene = scene_of(layered_boxes(3));
    scene.bottoms[0].geometries[0].boxes[1].lo.x = NAN;
    const std::vector<Candidate> found = Expectation(scene).candidates(up(0.5f, 0.5f));
    ASSERT_EQ(found.size(), 2u);
    EXPECT_TRUE(found[0].is_box && found[0].is_sure && found[1].is_sure);
    EXPECT_EQ(found[1].primitive, 2u);
    EXPECT_EQ(found[1].t_low, 4);
    EXPECT_EQ(found[1].t_high, 5);
    for (const Candidate& candidate : Expectation(scene).candidates(up(1, 0.5f)))
        EXPECT_FALSE(candidate.is_sure) << "along a side";
    Shot shot = up(0.5f, 0.5f);
    shot.ray.t_max = 3;
    EXPECT_FALSE(Expectation(scene).candidates(shot)[1].is_sure);
}

// The first of the candidates is the reference's closest hit, where both are sure.
TEST(ConformanceExpectation, AgreesWithTheReference) {
    Draws draws(3);
    SceneInput scene = scene_of(random_triangles(draws, 24));
    scene.top.instances.resize(3);
    for (InstanceInput& instance : scene.top.instances) instance.to_world = random_instance_transform(draws);
    const GeometryInput& geometry = scene.bottoms[0].geometries[0];
    const MeshView mesh("mesh", geometry.positions, geometry.triangles);
    std::vector<ReferenceInstance> instances;
    for (const InstanceInput& instance : scene.top.instances) instances.push_back({0, instance.to_world});
    const ReferenceScene reference(std::span(&mesh, 1), instances);
    const Expectation expectation(scene);
    std::size_t hits = 0, told_apart = 0;
    for (const Shot& shot : random_shots(draws, 2000)) {
        const std::vector<Candidate> all = expectation.candidates(shot);
        const auto first = std::ranges::min_element(all, {}, &Candidate::t_low);
        const ReferenceHit hit = reference.closest_hit(shot.ray);
        if (hit.hit) {
            ASSERT_NE(first, all.end());
            if (!first->is_sure) continue;
            EXPECT_EQ(first->instance, hit.instance);
            EXPECT_EQ(first->primitive, hit.primitive);
            EXPECT_TRUE(first->t_low <= hit.t && hit.t <= first->t_high);
            EXPECT_TRUE(expectation.is_on_ray(shot, *first, vec2(hit.u, hit.v)));
            told_apart += !expectation.is_on_ray(shot, *first, vec2(hit.u + 0.01, hit.v));
            ++hits;
        } else {
            EXPECT_FALSE(std::ranges::any_of(all, &Candidate::is_sure));
        }
    }
    EXPECT_GT(hits, 500u);
    EXPECT_GT(told_apart, hits * 19 / 20) << "all but what is seen nearly edge-on";
}

}  // namespace
}  // namespace twinray::conformance
