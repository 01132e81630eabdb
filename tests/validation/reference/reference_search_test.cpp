// The reference's search: areas of triangles, rays against triangles and boxes, and searches without boxes, which give
// the same.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "tests/validation/reference/meshes.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/bvh64.h"
#include "validation/reference/reference_scene.h"
#include "validation/reference/geometry64.h"

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

Box64 box_at(const dvec3& low, double size) {
    Box64 box;
    box.include(low);
    box.include(low + size);
    return box;
}

// The items in the leaves that a ray visits, each expected once.
std::set<uint> visited(const Bvh64& bvh, const dvec3& origin, const dvec3& direction) {
    std::set<uint> items;
    const double no_limit = INFINITY;
    bvh.visit_leaves(SlabRay(origin, direction, 0), 0, no_limit, [&](uint first, uint last) {
        EXPECT_LE(last - first, 4u);
        for (uint i = first; i < last; ++i) EXPECT_TRUE(items.insert(bvh.order()[i]).second) << i;
        return true;
    });
    return items;
}

TEST(Bvh64, RayThroughAllBoxesVisitsEachItemOnce) {
    std::vector<Box64> boxes;
    for (int i = 0; i < 1000; ++i) boxes.push_back(box_at({i * 7 % 1000, 0, 0}, 0.5));
    const Bvh64 bvh(boxes);
    EXPECT_EQ(visited(bvh, {-1, 0.25, 0.25}, {1, 0, 0}).size(), 1000u);
    EXPECT_EQ(visited(bvh, {2000, 0.25, 0.25}, {-1, -0.0, 0}).size(), 1000u);
    EXPECT_EQ(visited(bvh, {-1, 0.75, 0.25}, {1, 0, 0}).size(), 0u);
    EXPECT_LT(visited(bvh, {500, -1, 0.25}, {0, 1, 0}).size(), 9u);
}

TEST(Bvh64, DepthIsBoundedForSizesThatHalveAThousandTimes) {
    std::vector<Box64> boxes;
    for (int i = -500; i < 500; ++i) boxes.push_back(box_at({std::ldexp(1.0, i), 0, 0}, std::ldexp(0.5, i)));
    const Bvh64 bvh(boxes);
    EXPECT_EQ(visited(bvh, {-1, 0, 0}, {1, 0, 0}).size(), 1000u);
    EXPECT_EQ(visited(bvh, {std::ldexp(1.0, 510), 0, 0}, {-1, 0, 0}).size(), 1000u);
}

TEST(Bvh64, EqualBoxesAreSplitByHalves) {
    const std::vector<Box64> boxes(1000, box_at({1, 2, 3}, 1));
    EXPECT_EQ(visited(Bvh64(boxes), {0, 2.5, 3.5}, {1, 0, 0}).size(), 1000u);
}

TEST(Bvh64, OfNothingIsNeverVisited) {
    EXPECT_TRUE(visited(Bvh64(std::span<const Box64>()), {0, 0, 0}, {1, 0, 0}).empty());
    EXPECT_TRUE(visited(Bvh64(), {0, 0, 0}, {1, 0, 0}).empty());
    EXPECT_TRUE(Bvh64().bounds().is_empty());
}

TEST(SlabRay, IntervalOfABoxContainsThatOfEveryBoxInside) {
    const Box64 outer = box_at({-1, -1, -1}, 2);
    for (int i = 0; i < 2000; ++i) {
        const auto fraction = [&](int k) { return std::fmod(i * 0.618033988749895 * k, 1.0); };
        const Box64 inner = box_at({-fraction(1), -fraction(2), fraction(3) - 1}, fraction(4));
        const dvec3 origin(fraction(5) * 5 - 2.5, fraction(6) * 5 - 2.5, i % 3 == 0 ? -1 : fraction(7));
        const dvec3 direction(fraction(8) - 0.5, i % 2 == 0 ? 0.0 : fraction(9) - 0.5, i % 3 == 0 ? -0.0 : 0.1);
        const SlabRay ray(origin, direction, 0);
        const Interval64 wide = ray.clip(outer), narrow = ray.clip(inner);
        ASSERT_LE(wide.near, narrow.near) << i;
        ASSERT_GE(wide.far, narrow.far) << i;
    }
}

TEST(SlabRay, ZeroComponentsOfEitherSignAcceptRaysOnAndBetweenThePlanes) {
    const Box64 box = box_at({0, 0, 0}, 1);
    for (const double zero : {0.0, -0.0}) {
        for (const double y : {0.0, 0.5, 1.0}) {
            const Interval64 t = SlabRay({-2, y, 0.5}, {1, zero, zero}, 0).clip(box);
            EXPECT_EQ(t.near, 2) << y;
            EXPECT_EQ(t.far, 3) << y;
        }
        for (const double y : {-0.5, 1.5}) EXPECT_TRUE(SlabRay({-2, y, 0.5}, {1, zero, zero}, 0).clip(box).is_empty());
    }
}

TEST(SlabRay, PadGrowsTheBoxOnEverySide) {
    const Box64 box = box_at({0, 0, 0}, 1);
    for (const double sign : {1.0, -1.0}) {
        const Interval64 t = SlabRay({0.5 - 2.5 * sign, 1.25, -0.25}, {sign, 0, 0}, 0.25).clip(box);
        EXPECT_EQ(t.near, 1.75);
        EXPECT_EQ(t.far, 3.25);
    }
}

using namespace test;  // NOLINT

// The search answers what testing every triangle answers, bit for bit.

Bounds to_bounds(const Box64& box) { return {vec3(box.corners[0]), vec3(box.corners[1])}; }

// Returns random and aimed rays, the same with an interval that cuts hits off, and axis-aligned ones, +0 and -0.
std::vector<Ray> all_kinds_of_rays(const ReferenceScene& reference, std::size_t count, std::uint64_t seed) {
    std::vector<Ray> rays = random_rays(to_bounds(reference.bounds()), count, seed);
    for (const auto& more : {vertex_aimed_rays(reference, count, seed), edge_aimed_rays(reference, count, seed)})
        rays.insert(rays.end(), more.begin(), more.end());
    for (std::size_t i = 0; i < 3 * count; i += 3) {
        rays.push_back(rays[i]);
        rays.back().t_min = 0.5f;
        rays.back().t_max = 1.5f;
    }
    for (std::size_t i = 0; i < count; ++i) {
        Ray ray = rays[i];
        const int axis = static_cast<int>(i % 3);
        ray.direction = vec3(i % 2 == 0 ? 0.0f : -0.0f);
        ray.direction[axis] = i % 4 < 2 ? 2.0f : -2.0f;
        if (i % 5 == 0) ray.origin = round(ray.origin);  // onto the planes of grids and cubes
        rays.push_back(ray);
    }
    return rays;
}

void expect_equals_brute_force(const ReferenceScene& reference, std::uint64_t seed) {
    std::size_t hits = 0;
    for (const Ray& ray : all_kinds_of_rays(reference, 300, seed)) {
        const ReferenceHit expected = reference.closest_hit_brute_force(ray);
        ASSERT_EQ(reference.closest_hit(ray), expected)
            << "seed " << seed << ", origin " << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z
            << ", direction " << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z << ", expected t "
            << expected.t << " of " << expected.primitive;
        ASSERT_EQ(reference.any_hit(ray), expected.hit) << "seed " << seed;
        hits += expected.hit;
    }
    EXPECT_GT(hits, 100u) << "seed " << seed;
}

std::vector<ReferenceInstance> stiff_instances() {
    const Transform mirrored = Transform::translation({5, 0, 0}) * Transform::scaling({-1, 1, 1});
    const Transform stretched = rotation(0.4f, 1.1f) * Transform::scaling({1e3f, 1, 1e-3f});
    const Transform nested = rotation(0.3f, 0.2f) * (Transform::translation({1, -7, 3}) * rotation(1.7f, -0.6f));
    const Transform far = Transform::translation({1e6f, -1e6f, 1e6f}) * rotation(2.0f, 0.1f);
    return {{0, {}, 7}, {1, mirrored, 8}, {0, stretched, 9}, {1, nested, 10}, {0, far, 11}, {0, {}, 12}};
}

TEST(ReferenceSearch, EqualsBruteForce) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        expect_equals_brute_force(reference_of(random_soup(700, 0.5f, seed)), seed);
        expect_equals_brute_force(reference_of(random_soup(700, 0.01f * static_cast<float>(seed), seed)), seed);
    }
    expect_equals_brute_force(reference_of(grid(20, 0, 0, 1)), 11);
    expect_equals_brute_force(reference_of(grid(20, 0.3f, 0.3f, 1)), 12);
    expect_equals_brute_force(reference_of(sphere(3)), 21);
    expect_equals_brute_force(reference_of(cube()), 22);
    expect_equals_brute_force(reference_of({sphere(2), cube()}, stiff_instances()), 31);
    expect_equals_brute_force(reference_of({random_soup(200, 0.3f, 5), grid(8, 0, 0, 1)}, stiff_instances()), 32);
}

TEST(ReferenceSearch, EqualsBruteForceOnManyInstances) {
    std::mt19937 random(41);
    std::vector<ReferenceInstance> instances;
    for (uint i = 0; i < 200; ++i) {
        const Transform turn = rotation(uniform(random, -3, 3), uniform(random, -3, 3));
        instances.push_back({i % 2, Transform::translation(uniform3(random, -9, 9)) * turn, i});
    }
    expect_equals_brute_force(reference_of({sphere(1), cube()}, instances), 41);
}

TEST(ReferenceSearch, EqualsBruteForceOnSliversSeenEdgeOn) {
    std::mt19937 random(51);
    Soup soup;
    for (int i = 0; i < 500; ++i) {
        const vec3 a = uniform3(random, -1, 1);
        const vec3 b = uniform3(random, -1, 1);
        soup.add(a, b, mix(a, b, 0.5f) + 1e-6f * uniform3(random, -1, 1));
    }
    const ReferenceScene reference = reference_of(soup);
    expect_equals_brute_force(reference, 51);
    for (std::size_t i = 0; i + 3 <= soup.positions.size(); i += 3) {  // along the slivers
        const vec3 along = soup.positions[i + 1] - soup.positions[i];
        const Ray ray = make_ray(soup.positions[i] - along, along);
        ASSERT_EQ(reference.closest_hit(ray), reference.closest_hit_brute_force(ray)) << "sliver " << i / 3;
    }
}

// Rays lie in the very plane of triangles but for the 2^-53 that the inverse matrix adds: the edge functions are noise
// of any sign, and t would be anywhere between the vertices if it were not held in the triangle's box.
TEST(ReferenceSearch, EqualsBruteForceOnTrianglesSeenEdgeOn) {
    std::mt19937 random(53);
    const auto integer = [&](int low, int high) { return float(low + int(random() % uint(high - low + 1))); };
    const auto integers = [&] { return vec3(integer(-5, 5), integer(-5, 5), integer(-5, 5)); };
    std::size_t hits = 0;
    for (int scene = 0; scene < 300; ++scene) {
        const Transform transform = {{vec4(integers(), 1), vec4(integers(), 2), vec4(integers(), 3)}};
        if (determinant(transform) == 0) continue;
        const vec3 origin = integers(), d = integers() + vec3(6), e = integers();
        Soup soup;
        for (int i = 0; i < 60; ++i) {
            const auto vertex = [&] { return origin + integer(1, 99) * d + integer(-99, 99) * e; };
            const vec3 a = vertex(), b = vertex();
            soup.add(a, b, vertex());
        }
        const ReferenceScene reference = reference_of({soup}, {{0, transform, 0}});
        const Ray ray = make_ray(transform_point(transform, origin), transform_vector(transform, d));
        const ReferenceHit expected = reference.closest_hit_brute_force(ray);
        ASSERT_EQ(reference.closest_hit(ray), expected) << "scene " << scene;
        hits += expected.hit;
    }
    EXPECT_GT(hits, 100u);
}

}  // namespace
}  // namespace twinray
