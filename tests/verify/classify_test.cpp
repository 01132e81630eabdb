// SPDX-License-Identifier: MIT
#include "engine/verify/classify.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "tests/verify/float32_kernels.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

constexpr std::uint32_t seed = 77;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Verdict both(Class software, Class hardware) { return {software, hardware}; }

// The same answer from both accelerators.
Verdict judge(const Oracle& oracle, const Ray& ray, const Hit& hit) { return classify(oracle, ray, hit, hit); }

Hit hit_of(const OracleHit& hit) {
    return {1, float(hit.t), hit.primitive, 0, float(hit.u), float(hit.v), hit.instance, 0};
}

Scene32 one(const Soup& soup, const Transform& transform = {}) { return {{soup}, {{0, transform, 0}}}; }

// Unit squares in z = 4 and z = 6: triangles 0, 1 and 2, 3, split along x = y.
Scene32 two_sheets() {
    Soup soup;
    for (const float z : {4.0f, 6.0f}) {
        soup.add({0, 0, z}, {1, 0, z}, {1, 1, z});
        soup.add({0, 0, z}, {1, 1, z}, {0, 1, z});
    }
    return one(soup);
}

const Ray inner_ray = make_ray({0.7f, 0.2f, 0}, {0, 0, 1});
const Hit near_hit = {1, 4, 0, 0, 0.5f, 0.2f, 0, 0};
const Hit far_hit = {1, 6, 2, 0, 0.5f, 0.2f, 0, 0};

TEST(Classify, RightAnswersAgree) {
    const Oracle oracle = two_sheets().oracle();
    EXPECT_EQ(judge(oracle, inner_ray, near_hit), both(Class::agree, Class::agree));
    EXPECT_EQ(judge(oracle, make_ray({2, 2, 0}, {0, 0, 1}), miss()), both(Class::agree, Class::agree));
}

TEST(Classify, AnAcceleratorWithoutAnAnswerIsNotJudged) {
    const Verdict verdict = classify(two_sheets().oracle(), inner_ray, near_hit, std::nullopt);
    EXPECT_EQ(verdict.software, Class::agree);
    EXPECT_EQ(verdict.hardware, std::nullopt);
}

TEST(Classify, InteriorHitReportedAsMissIsALeak) {
    EXPECT_EQ(judge(two_sheets().oracle(), inner_ray, miss()), both(Class::sw_leak, Class::hw_leak));
}

TEST(Classify, FarHitInPlaceOfANearOneIsALeak) {
    EXPECT_EQ(judge(two_sheets().oracle(), inner_ray, far_hit), both(Class::sw_leak, Class::hw_leak));
}

TEST(Classify, FarHitThroughASharedEdgeIsALeak) {
    const Ray ray = make_ray({0.5f, 0.5f, 0}, {0, 0, 1});
    const Hit through = {1, 6, 2, 0, 0, 0.5f, 0, 0};
    EXPECT_EQ(judge(two_sheets().oracle(), ray, through), both(Class::sw_leak, Class::hw_leak));
}

TEST(Classify, TriangleThatTheRayClearlyMissesIsFalse) {
    const Oracle oracle = two_sheets().oracle();
    const Hit other = {1, 4, 1, 0, 0.2f, 0, 0, 0};
    EXPECT_EQ(judge(oracle, inner_ray, other), both(Class::sw_false, Class::hw_false));
    EXPECT_EQ(judge(oracle, make_ray({2, 2, 0}, {0, 0, 1}), near_hit), both(Class::sw_false, Class::hw_false));
}

TEST(Classify, HitOutsideTheIntervalIsFalse) {
    Ray ray = inner_ray;
    ray.t_min = 4.5f;
    EXPECT_EQ(judge(two_sheets().oracle(), ray, near_hit), both(Class::sw_false, Class::hw_false));
}

TEST(Classify, PrimitiveOrInstanceThatCannotBeHitIsFalse) {
    Scene32 scene = two_sheets();
    scene.soups[0].add(vec3(nan), vec3(0), vec3(1));
    const Oracle oracle = scene.oracle();
    for (const auto& [primitive, instance] : {std::pair{4u, 0u}, std::pair{5u, 0u}, std::pair{0u, 1u}}) {
        Hit hit = near_hit;
        hit.primitive_index = primitive;
        hit.instance_index = instance;
        EXPECT_EQ(judge(oracle, inner_ray, hit), both(Class::sw_false, Class::hw_false));
    }
}

TEST(Classify, NeighbourAcrossASharedEdgeIsATie) {
    const Oracle oracle = two_sheets().oracle();
    const Ray ray = make_ray({0.5f, 0.5f, 0}, {0, 0, 1});
    ASSERT_EQ(oracle.closest_hit(ray).primitive, 0u);
    const Hit neighbour = {1, 4, 1, 0, 0.5f, 0, 0, 0};
    EXPECT_EQ(judge(oracle, ray, neighbour), both(Class::tie, Class::tie));
}

TEST(Classify, SilhouetteIsBoundary) {
    const Oracle oracle = two_sheets().oracle();
    const Ray on_rim = make_ray({1, 0.5f, 0}, {0, 0, 1});
    ASSERT_TRUE(oracle.closest_hit(on_rim).hit);
    EXPECT_EQ(judge(oracle, on_rim, {1, 6, 2, 0, 0.5f, 0.5f, 0, 0}), both(Class::boundary, Class::boundary));
    EXPECT_EQ(judge(oracle, on_rim, miss()), both(Class::boundary, Class::boundary_hw_miss));
    const Ray past_rim = make_ray({std::nextafter(1.0f, 2.0f), 0.5f, 0}, {0, 0, 1});
    ASSERT_FALSE(oracle.closest_hit(past_rim).hit);
    EXPECT_EQ(judge(oracle, past_rim, {1, 4, 0, 0, 0.5f, 0.5f, 0, 0}), both(Class::boundary, Class::boundary));
}

TEST(Classify, RayDownTheWallOfACubeMayHitTopOrFloor) {
    Scene32 scene = one(cube());
    scene.soups[0].add({-9, -9, 0}, {9, -9, 0}, {0, 9, 0});
    const Oracle oracle = scene.oracle();
    const Ray ray = make_ray({1, 0.3f, 3}, {0, 0, -1});
    const OracleHit top = oracle.closest_hit(ray);
    ASSERT_EQ(top.t, 2);
    EXPECT_EQ(judge(oracle, ray, hit_of(top)), both(Class::agree, Class::agree));
    const OracleHit floor = oracle.closest_hit(make_ray({1 + 1e-6f, 0.3f, 3}, {0, 0, -1}));
    ASSERT_EQ(floor.primitive, 12u);
    EXPECT_EQ(judge(oracle, ray, hit_of(floor)), both(Class::boundary, Class::boundary));
    EXPECT_EQ(judge(oracle, ray, miss()), both(Class::sw_leak, Class::hw_leak));
}

TEST(Classify, WrongTIsTErr) {
    const Oracle oracle = two_sheets().oracle();
    Hit hit = near_hit;
    hit.t = 4 + 1e-4f;
    EXPECT_EQ(judge(oracle, inner_ray, hit), both(Class::t_err, Class::hw_t_err));
    hit.t = std::nextafter(4.0f, 5.0f);
    EXPECT_EQ(judge(oracle, inner_ray, hit), both(Class::agree, Class::agree));
}

TEST(Classify, HardwareIsAllowedTheErrorOfItsOwnInverse) {
    const Transform nearly_singular = {{vec4(1, 1, 0, 0), vec4(1, 1 + 0x1p-10f, 0, 0), vec4(0, 0, 1, 0)}};
    const Oracle oracle = one(two_sheets().soups[0], nearly_singular).oracle();
    const Ray ray = make_ray(transform_point(nearly_singular, {0.7f, 0.2f, 0}), {0, 0, 1});
    Hit hit = near_hit;
    ASSERT_EQ(judge(oracle, ray, hit), both(Class::agree, Class::agree));
    hit.t = 4.02f;
    EXPECT_EQ(judge(oracle, ray, hit), both(Class::t_err, Class::agree));
}

TEST(Classify, WrongBarycentricsAreOutOfRange) {
    const Oracle oracle = two_sheets().oracle();
    Hit swapped = near_hit;
    std::swap(swapped.u, swapped.v);
    EXPECT_EQ(judge(oracle, inner_ray, swapped), both(Class::t_err, Class::hw_range));
    for (float Hit::*field : {&Hit::t, &Hit::u, &Hit::v}) {
        Hit hit = near_hit;
        hit.*field = nan;
        EXPECT_EQ(judge(oracle, inner_ray, hit), both(Class::t_err, Class::hw_range));
    }
}

TEST(Classify, RaysThatNobodyMayTraceMustMiss) {
    const Oracle oracle = two_sheets().oracle();
    const Ray ray = make_ray(vec3(nan), {0, 0, 1});
    EXPECT_EQ(judge(oracle, ray, miss()), both(Class::agree, Class::agree));
    EXPECT_EQ(judge(oracle, ray, near_hit), both(Class::invalid_input, Class::invalid_input));
    EXPECT_EQ(classify_any(oracle, ray, true, false), both(Class::invalid_input, Class::agree));
}

TEST(Classify, HitAtAnEndOfTheIntervalIsUnspecified) {
    const Oracle oracle = two_sheets().oracle();
    Ray ray = inner_ray;
    ray.t_max = std::nextafter(4.0f, 5.0f);
    ASSERT_TRUE(oracle.closest_hit(ray).hit);
    EXPECT_EQ(judge(oracle, ray, miss()), both(Class::unspecified, Class::unspecified));
    ray.t_max = INFINITY;
    ray.t_min = 4;
    Hit hit = near_hit;
    hit.t = std::nextafter(4.0f, 5.0f);
    EXPECT_EQ(judge(oracle, ray, hit), both(Class::unspecified, Class::unspecified));
}

TEST(Classify, DistanceBeyondFloat32IsUnspecified) {
    Ray ray = inner_ray;
    ray.direction.z = 1e-39f;
    ASSERT_TRUE(two_sheets().oracle().closest_hit(ray).hit);
    EXPECT_EQ(judge(two_sheets().oracle(), ray, miss()), both(Class::unspecified, Class::unspecified));
}

// No rounding excuses a miss of a closed mesh from inside.
void expect_misses_leak(const Soup& soup, const Transform& transform = {}) {
    const Oracle oracle = one(soup, transform).oracle();
    std::vector<Ray> rays = rays_from_inside(soup, transform, 1000, seed);
    for (std::size_t i = 0; i < 100; ++i)  // exactly through corners, where nothing moves them
        rays.push_back(make_ray(transform_point(transform, vec3(0)),
                                transform_vector(transform, soup.positions[i % soup.positions.size()])));
    for (const Ray& ray : rays) {
        ASSERT_TRUE(oracle.closest_hit(ray).hit);
        ASSERT_EQ(judge(oracle, ray, miss()), both(Class::sw_leak, Class::hw_leak))
            << "seed " << seed << ", direction " << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z;
        ASSERT_EQ(classify_any(oracle, ray, false, true), both(Class::sw_leak, Class::agree)) << "seed " << seed;
    }
}

TEST(Classify, MissFromInsideAClosedSphereIsALeakAlsoAtCornersAndEdges) { expect_misses_leak(sphere(3)); }

TEST(Classify, LeaksAreFoundWhateverTheWinding) {
    Soup soup = sphere(3);
    for (std::size_t i = 0; i < soup.triangles.size(); i += 3) std::swap(soup.triangles[i].x, soup.triangles[i].y);
    expect_misses_leak(soup);
}

TEST(Classify, LeaksAreFoundInDoubledSurfacesAndWithoutSharedIndices) {
    Soup doubled;
    const Soup indexed = sphere(3);
    for (const uvec3& t : indexed.triangles) {
        doubled.add(indexed.positions[t.x], indexed.positions[t.y], indexed.positions[t.z]);
        doubled.add(indexed.positions[t.y], indexed.positions[t.x], indexed.positions[t.z]);
    }
    expect_misses_leak(doubled);
}

TEST(Classify, LeaksAreFoundInMovedAndStretchedInstances) {
    const Transform stretched = rotation(0.5f, 0.3f) * Transform::scaling({1, 2, 3});
    expect_misses_leak(sphere(3), Transform::translation({1, 2, 3}) * stretched);
}

// The square's right half is split at (1, 0.3), which is no corner of the left half.
TEST(Classify, TJunctionIsUnspecified) {
    Soup soup;
    soup.add({0, 0, 4}, {1, 0, 4}, {1, 1, 4});
    soup.add({1, 0, 4}, {2, 0, 4}, {1, 0.3f, 4});
    soup.add({1, 0.3f, 4}, {2, 0, 4}, {1, 1, 4});
    const Oracle oracle = one(soup).oracle();
    const Ray ray = make_ray({1, 0.3f, 0}, {0, 0, 1});
    EXPECT_EQ(judge(oracle, ray, miss()), both(Class::unspecified, Class::unspecified));
}

TEST(Classify, SilhouetteOfAClosedMeshIsBoundary) {
    const Oracle oracle = one(cube()).oracle();
    for (const float x : {0.0f, 1.0f}) {
        const Ray down_a_wall = make_ray({x, 0.3f, 3}, {0, 0, -1});
        EXPECT_EQ(judge(oracle, down_a_wall, miss()), both(Class::boundary, Class::boundary_hw_miss));
        EXPECT_EQ(classify_any(oracle, down_a_wall, false, false), both(Class::boundary, Class::boundary_hw_miss));
    }
}

TEST(Classify, AnyHitIsJudgedByHitAndMiss) {
    const Oracle oracle = two_sheets().oracle();
    EXPECT_EQ(classify_any(oracle, inner_ray, true, false), both(Class::agree, Class::hw_leak));
    EXPECT_EQ(classify_any(oracle, make_ray({2, 2, 0}, {0, 0, 1}), true, false), both(Class::sw_false, Class::agree));
    const Ray past_rim = make_ray({std::nextafter(1.0f, 2.0f), 0.5f, 0}, {0, 0, 1});
    EXPECT_EQ(classify_any(oracle, past_rim, true, false), both(Class::boundary, Class::agree));
}

TEST(ClassifyAll, JudgesEachRayAndRejectsListsOfAnotherLength) {
    const Oracle oracle = two_sheets().oracle();
    const std::vector<Ray> rays(3, inner_ray);
    const std::vector<Hit> hits = {near_hit, far_hit, miss()};
    const std::vector<Verdict> verdicts = classify_all(oracle, rays, hits, {});
    ASSERT_EQ(verdicts.size(), 3u);
    EXPECT_EQ(verdicts[0], (Verdict{Class::agree, {}}));
    EXPECT_EQ(verdicts[1], (Verdict{Class::sw_leak, {}}));
    EXPECT_EQ(verdicts[2], (Verdict{Class::sw_leak, {}}));
    EXPECT_THROW(classify_all(oracle, rays, {hits.data(), 2}, {}), Error);
}

}  // namespace
}  // namespace twinray
