// Input for a driver, the rules that decide whether it must be hit, and the hits that float64 expects.
#include "report/conformance/expectation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "engine/core/error.h"
#include "report/conformance/inputs.h"
#include "report/conformance/driver.h"
#include "validation/reference/reference_scene.h"

namespace twinray::conformance {
namespace {

template <class T>
T at(const std::vector<std::byte>& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

GeometryInput triangle() {
    return {.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, -0.5f)}, .triangles = {uvec3(2, 1, 0)}};
}

TEST(ConformanceInput, VerticesAreInTheirFormat) {
    GeometryInput geometry = triangle();
    EXPECT_EQ(vertex_stride(geometry), 12u);
    EXPECT_EQ(at<float>(encoded_vertices(geometry), 2 * 12 + 8), -0.5f);
    geometry.format = VK_FORMAT_R16G16B16A16_SNORM;
    geometry.padding = 4;
    EXPECT_EQ(vertex_stride(geometry), 12u);
    EXPECT_EQ(at<std::int16_t>(encoded_vertices(geometry), 12), 32767);
    EXPECT_EQ(at<std::int16_t>(encoded_vertices(geometry), 2 * 12 + 4), -16384);
    geometry.format = VK_FORMAT_R16G16_SFLOAT;
    geometry.padding = 0;
    EXPECT_EQ(vertex_stride(geometry), 4u);
    EXPECT_EQ(at<std::uint16_t>(encoded_vertices(geometry), 4), 0x3c00) << "1 as a half";
    geometry.format = VK_FORMAT_R8_UNORM;
    EXPECT_THROW(encoded_vertices(geometry), Error);
}

TEST(ConformanceInput, WhatIsPassedOverComesFirst) {
    GeometryInput geometry = triangle();
    geometry.first_vertex = 2;
    EXPECT_EQ(encoded_vertices(geometry).size(), (2u + 3 + 2) * 12);
    EXPECT_EQ(at<float>(encoded_vertices(geometry), 3 * 12), 1) << "the second of the triangle's";
    geometry.indices = Indices::bits16;
    geometry.earlier_items = 2;
    EXPECT_EQ(encoded_indices(geometry).size(), 3u * 6);
    EXPECT_EQ(at<std::uint16_t>(encoded_indices(geometry), 12), 2);
    geometry.indices = Indices::none;
    EXPECT_TRUE(encoded_indices(geometry).empty());
    EXPECT_EQ(encoded_vertices(geometry).size(), (2u + 6 + 3 + 2) * 12);
    const GeometryInput boxes{.boxes = {{vec3(0), vec3(1)}}, .padding = 8, .earlier_items = 1};
    EXPECT_EQ(encoded_boxes(boxes).size(), 2u * 32);
    EXPECT_EQ(at<float>(encoded_boxes(boxes), 32 + 12), 1);
}

constexpr VkGeometryFlagsKHR opaque = VK_GEOMETRY_OPAQUE_BIT_KHR;
constexpr VkGeometryInstanceFlagsKHR force_opaque = VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR,
                                     force_no_opaque = VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR,
                                     no_culling = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR,
                                     flipped = VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR;

TEST(ConformanceRules, TheRaySaysLastWhatIsOpaque) {
    EXPECT_TRUE(is_opaque({opaque, 0, 0}));
    EXPECT_FALSE(is_opaque({0, 0, 0}));
    EXPECT_FALSE(is_opaque({opaque, force_no_opaque, 0}));
    EXPECT_TRUE(is_opaque({0, force_opaque, 0}));
    EXPECT_TRUE(is_opaque({opaque, force_no_opaque, ray_opaque}));
    EXPECT_FALSE(is_opaque({0, force_opaque, ray_no_opaque}));
}

TEST(ConformanceRules, OpacityIsCulledAsItCameOut) {
    EXPECT_TRUE(is_culled_triangle({opaque, 0, ray_culls_opaque}, true));
    EXPECT_FALSE(is_culled_triangle({opaque, force_no_opaque, ray_culls_opaque}, true));
    EXPECT_TRUE(is_culled_box({opaque, force_no_opaque, ray_culls_no_opaque}));
    EXPECT_FALSE(is_culled_box({opaque, 0, ray_culls_no_opaque}));
}

TEST(ConformanceRules, FacesAreCulledUnlessTheInstanceForbids) {
    EXPECT_TRUE(is_culled_triangle({opaque, 0, ray_culls_back}, false));
    EXPECT_FALSE(is_culled_triangle({opaque, 0, ray_culls_back}, true));
    EXPECT_TRUE(is_culled_triangle({opaque, 0, ray_culls_front}, true));
    EXPECT_TRUE(is_culled_triangle({opaque, flipped, ray_culls_back}, true));
    EXPECT_FALSE(is_culled_triangle({opaque, flipped, ray_culls_back}, false));
    EXPECT_FALSE(is_culled_triangle({opaque, no_culling, ray_culls_back}, false));
    EXPECT_FALSE(is_culled_box({opaque, 0, ray_culls_back | ray_culls_front}));
}

TEST(ConformanceRules, KindsAreSkippedWhateverTheInstanceSays) {
    EXPECT_TRUE(is_culled_triangle({opaque, no_culling, ray_skips_triangles}, true));
    EXPECT_FALSE(is_culled_box({opaque, 0, ray_skips_triangles}));
    EXPECT_TRUE(is_culled_box({opaque, 0, ray_skips_boxes}));
    EXPECT_FALSE(is_culled_triangle({opaque, 0, ray_skips_boxes}, true));
}

// Returns two triangles of a square at z = 2, counterclockwise seen from above.
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

// If both are sure, the first of the candidates is the reference's closest hit.
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
