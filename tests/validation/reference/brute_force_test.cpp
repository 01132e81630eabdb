// SPDX-License-Identifier: MIT
// The reference's search answers what testing every triangle answers, bit for bit.
#include <gtest/gtest.h>

#include "validation/reference/aimed_rays.h"
#include "validation/reference/reference_scene.h"
#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

Bounds to_bounds(const Box64& box) { return {vec3(box.corners[0]), vec3(box.corners[1])}; }

// Random and aimed rays, and the same with an interval that cuts hits off; and axis-aligned ones, +0 and -0.
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

TEST(ReferenceSearch, EqualsBruteForceOnRandomSoups) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        expect_equals_brute_force(reference_of(random_soup(700, 0.5f, seed)), seed);
        expect_equals_brute_force(reference_of(random_soup(700, 0.01f * static_cast<float>(seed), seed)), seed);
    }
}

TEST(ReferenceSearch, EqualsBruteForceOnFlatAndRoughGrids) {
    expect_equals_brute_force(reference_of(grid(20, 0, 0, 1)), 11);
    expect_equals_brute_force(reference_of(grid(20, 0.3f, 0.3f, 1)), 12);
}

TEST(ReferenceSearch, EqualsBruteForceOnSpheresAndCubes) {
    expect_equals_brute_force(reference_of(sphere(3)), 21);
    expect_equals_brute_force(reference_of(cube()), 22);
}

TEST(ReferenceSearch, EqualsBruteForceUnderNestedMirroredAndStretchedInstances) {
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

// Rays in the very plane of triangles but for the 2^-53 that the inverse matrix adds: the edge functions are noise of
// any sign, and t would be anywhere between the vertices if it were not held in the triangle's box.
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
