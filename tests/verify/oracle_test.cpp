// SPDX-License-Identifier: MIT
#include "engine/verify/oracle.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "engine/verify/aimed_rays.h"
#include "tests/verify/meshes.h"

namespace twinray {
namespace {

using namespace testing;  // NOLINT

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Oracle oracle_of(const std::vector<Soup>& soups, const std::vector<OracleInstance>& instances) {
    std::vector<MeshView> views;
    for (const Soup& soup : soups) views.push_back(soup.view());
    return {views, instances};
}

Oracle oracle_of(const Soup& soup) { return oracle_of(std::vector<Soup>{soup}, {{}}); }

// One sheet: z = 4 over the unit square.
Oracle plane_at_4() {
    Soup soup;
    soup.add({0, 0, 4}, {1, 0, 4}, {1, 1, 4});
    soup.add({0, 0, 4}, {1, 1, 4}, {0, 1, 4});
    return oracle_of(soup);
}

Bounds to_bounds(const Box64& box) { return {vec3(box.corners[0]), vec3(box.corners[1])}; }

// Random and aimed rays, and the same with an interval that cuts hits off; and axis-aligned ones, +0 and -0.
std::vector<Ray> all_kinds_of_rays(const Oracle& oracle, std::size_t count, std::uint64_t seed) {
    std::vector<Ray> rays = random_rays(to_bounds(oracle.bounds()), count, seed);
    for (const auto& more : {vertex_aimed_rays(oracle, count, seed), edge_aimed_rays(oracle, count, seed)})
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
        if (i % 5 == 0) ray.origin = glm::round(ray.origin);  // onto the planes of grids and cubes
        rays.push_back(ray);
    }
    return rays;
}

void expect_equals_brute_force(const Oracle& oracle, std::uint64_t seed) {
    std::size_t hits = 0;
    for (const Ray& ray : all_kinds_of_rays(oracle, 300, seed)) {
        const OracleHit expected = oracle.closest_hit_brute_force(ray);
        ASSERT_EQ(oracle.closest_hit(ray), expected) << "seed " << seed << ", origin " << ray.origin.x << " "
            << ray.origin.y << " " << ray.origin.z << ", direction " << ray.direction.x << " " << ray.direction.y
            << " " << ray.direction.z << ", expected t " << expected.t << " of " << expected.primitive;
        ASSERT_EQ(oracle.any_hit(ray), expected.hit) << "seed " << seed;
        hits += expected.hit;
    }
    EXPECT_GT(hits, 100u) << "seed " << seed;
}

std::vector<OracleInstance> stiff_instances() {
    const Transform mirrored = Transform::translation({5, 0, 0}) * Transform::scaling({-1, 1, 1});
    const Transform stretched = rotation(0.4f, 1.1f) * Transform::scaling({1e3f, 1, 1e-3f});
    const Transform nested = rotation(0.3f, 0.2f) * (Transform::translation({1, -7, 3}) * rotation(1.7f, -0.6f));
    const Transform far = Transform::translation({1e6f, -1e6f, 1e6f}) * rotation(2.0f, 0.1f);
    return {{0, {}, 7}, {1, mirrored, 8}, {0, stretched, 9}, {1, nested, 10}, {0, far, 11}, {0, {}, 12}};
}

TEST(Oracle, EqualsBruteForceOnRandomSoups) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        expect_equals_brute_force(oracle_of(random_soup(700, 0.5f, seed)), seed);
        expect_equals_brute_force(oracle_of(random_soup(700, 0.01f * static_cast<float>(seed), seed)), seed);
    }
}

TEST(Oracle, EqualsBruteForceOnFlatAndRoughGrids) {
    expect_equals_brute_force(oracle_of(grid(20, 0, 0, 1)), 11);
    expect_equals_brute_force(oracle_of(grid(20, 0.3f, 0.3f, 1)), 12);
}

TEST(Oracle, EqualsBruteForceOnSpheresAndCubes) {
    expect_equals_brute_force(oracle_of(sphere(3)), 21);
    expect_equals_brute_force(oracle_of(cube()), 22);
}

TEST(Oracle, EqualsBruteForceUnderNestedMirroredAndStretchedInstances) {
    expect_equals_brute_force(oracle_of({sphere(2), cube()}, stiff_instances()), 31);
    expect_equals_brute_force(oracle_of({random_soup(200, 0.3f, 5), grid(8, 0, 0, 1)}, stiff_instances()), 32);
}

TEST(Oracle, EqualsBruteForceOnManyInstances) {
    std::mt19937 random(41);
    std::vector<OracleInstance> instances;
    for (uint i = 0; i < 200; ++i) {
        const Transform turn = rotation(uniform(random, -3, 3), uniform(random, -3, 3));
        instances.push_back({i % 2, Transform::translation(uniform3(random, -9, 9)) * turn, i});
    }
    expect_equals_brute_force(oracle_of({sphere(1), cube()}, instances), 41);
}

TEST(Oracle, EqualsBruteForceOnSliversSeenEdgeOn) {
    std::mt19937 random(51);
    Soup soup;
    for (int i = 0; i < 500; ++i) {
        const vec3 a = uniform3(random, -1, 1);
        const vec3 b = uniform3(random, -1, 1);
        soup.add(a, b, glm::mix(a, b, 0.5f) + 1e-6f * uniform3(random, -1, 1));
    }
    const Oracle oracle = oracle_of(soup);
    expect_equals_brute_force(oracle, 51);
    for (std::size_t i = 0; i + 3 <= soup.positions.size(); i += 3) {  // along the slivers
        const vec3 along = soup.positions[i + 1] - soup.positions[i];
        const Ray ray = make_ray(soup.positions[i] - along, along);
        ASSERT_EQ(oracle.closest_hit(ray), oracle.closest_hit_brute_force(ray)) << "sliver " << i / 3;
    }
}

// Rays in the very plane of triangles but for the 2^-53 that the inverse matrix adds: the edge functions are noise of
// any sign, and t would be anywhere between the corners if it were not held in the triangle's box.
TEST(Oracle, EqualsBruteForceOnTrianglesSeenEdgeOn) {
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
            const auto corner = [&] { return origin + integer(1, 99) * d + integer(-99, 99) * e; };
            const vec3 a = corner(), b = corner();
            soup.add(a, b, corner());
        }
        const Oracle oracle = oracle_of({soup}, {{0, transform, 0}});
        const Ray ray = make_ray(transform_point(transform, origin), transform_vector(transform, d));
        const OracleHit expected = oracle.closest_hit_brute_force(ray);
        ASSERT_EQ(oracle.closest_hit(ray), expected) << "scene " << scene;
        hits += expected.hit;
    }
    EXPECT_GT(hits, 100u);
}

TEST(Oracle, FindsWhatAPlainPlaneEquationFinds) {
    const std::uint32_t seed = 61;
    const Soup soup = random_soup(50, 0.5f, seed);
    const Oracle oracle = oracle_of(soup);
    for (const Ray& ray : random_rays({vec3(-1), vec3(1)}, 2000, seed)) {
        double best = INFINITY;
        const glm::dvec3 o(ray.origin), d(ray.direction);
        for (const uvec3& index : soup.triangles) {
            const glm::dvec3 a(soup.positions[index.x]), b(soup.positions[index.y]), c(soup.positions[index.z]);
            const glm::dvec3 n = glm::cross(b - a, c - a);
            const double t = glm::dot(a - o, n) / glm::dot(d, n);
            const glm::dvec3 p = o + t * d;
            const bool is_inside = glm::dot(glm::cross(b - a, p - a), n) >= 0 &&
                                   glm::dot(glm::cross(c - b, p - b), n) >= 0 &&
                                   glm::dot(glm::cross(a - c, p - c), n) >= 0;
            if (is_inside && t > 0) best = std::min(best, t);
        }
        const OracleHit hit = oracle.closest_hit(ray);
        ASSERT_EQ(hit.hit, best < INFINITY) << "seed " << seed;
        if (!hit.hit) continue;
        ASSERT_NEAR(hit.t, best, 1e-10 * best) << "seed " << seed;
        const uvec3 index = soup.triangles[hit.primitive];
        const glm::dvec3 point = (1 - hit.u - hit.v) * glm::dvec3(soup.positions[index.x]) +
                                 hit.u * glm::dvec3(soup.positions[index.y]) +
                                 hit.v * glm::dvec3(soup.positions[index.z]);
        ASSERT_LT(glm::length(point - (o + hit.t * d)), 1e-10) << "seed " << seed;
    }
}

TEST(Oracle, ClosedMeshesNeverLeakFromInside) {
    const std::uint32_t seed = 71;
    const Soup soup = sphere(4);
    for (const Transform& transform : {Transform{}, rotation(0.5f, 0.3f) * Transform::scaling({3, 1, 0.2f})}) {
        const Oracle oracle = oracle_of({soup}, {{0, transform, 0}});
        for (const Ray& ray : rays_from_inside(soup, transform, 40000, seed))
            ASSERT_TRUE(oracle.closest_hit(ray).hit) << "seed " << seed;
    }
}

TEST(Oracle, IntervalIsOpenAtBothEnds) {
    const Oracle oracle = plane_at_4();
    const auto hits = [&](float t_min, float t_max) {
        return oracle.closest_hit(make_ray({0.7f, 0.2f, 0}, {0, 0, 1}, t_min, t_max)).hit;
    };
    EXPECT_TRUE(hits(0, INFINITY));
    EXPECT_FALSE(hits(4, INFINITY));
    EXPECT_FALSE(hits(0, 4));
    EXPECT_TRUE(hits(std::nextafter(4.0f, 0.0f), INFINITY));
    EXPECT_TRUE(hits(0, std::nextafter(4.0f, 5.0f)));
    EXPECT_FALSE(hits(std::nextafter(4.0f, 5.0f), INFINITY));
}

TEST(Oracle, ReportsTInUnitsOfTheDirection) {
    const OracleHit hit = plane_at_4().closest_hit(make_ray({0.75f, 0.25f, 0}, {0, 0, 0.5f}));
    EXPECT_EQ(hit, (OracleHit{true, 8, 0.5, 0.25, 0, 0, 0}));
}

TEST(Oracle, NegativeTMinCountsAsZero) {
    const Oracle oracle = plane_at_4();
    EXPECT_FALSE(oracle.any_hit(make_ray({0.7f, 0.2f, 5}, {0, 0, 1}, -10)));
    EXPECT_FALSE(oracle.any_hit(make_ray({0.7f, 0.2f, 4}, {0, 0, 1}, -10)));
    EXPECT_TRUE(oracle.any_hit(make_ray({0.7f, 0.2f, 3}, {0, 0, 1}, -10)));
}

TEST(Oracle, RaysThatVulkanForbidsMiss) {
    const Oracle oracle = plane_at_4();
    const vec3 o(0.7f, 0.2f, 0), z(0, 0, 1);
    for (const Ray& ray : {make_ray(o, vec3(0)), make_ray({nan, 0, 0}, z), make_ray(o, {0, INFINITY, 1}),
                           make_ray(o, z, nan), make_ray(o, z, 0, nan), make_ray(o, z, 5, 3), make_ray(o, z, 0, -1)}) {
        EXPECT_FALSE(oracle.closest_hit(ray).hit);
        EXPECT_FALSE(oracle.closest_hit_brute_force(ray).hit);
        EXPECT_FALSE(oracle.any_hit(ray));
        EXPECT_TRUE(oracle.instances_hit(ray, INFINITY).empty());
    }
}

TEST(Oracle, NonFiniteAndDegenerateTrianglesAreNeverHit) {
    Soup soup;
    soup.add({0, 0, 1}, {1, 0, 1}, {nan, 1, 1});
    soup.add({0, 0, 1}, {1, 0, 1}, {1, INFINITY, 1});
    soup.add({0, 0, 1}, {1, 0, 1}, {1, 0, 1});
    soup.add({0, 0, 1}, {0.25f, 0.125f, 1}, {1, 0.5f, 1});  // on a line
    soup.add({0, 0, 1}, {0.1f, 0.3f, 1}, {0.7f, 2.1f, 1});  // not quite: rounded coordinates
    soup.add({0, 0, 4}, {1, 0, 4}, {1, 1, 4});
    const Oracle oracle = oracle_of(soup);
    const OracleHit hit = oracle.closest_hit(make_ray({0.25f, 0.125f, 0}, {0, 0, 1}));
    EXPECT_EQ(hit.primitive, 5u);
    EXPECT_EQ(hit.t, 4);
    for (const uint inactive : {0u, 1u, 2u, 3u}) EXPECT_EQ(oracle.geometry(0).find(inactive), nullptr) << inactive;
    EXPECT_NE(oracle.geometry(0).find(4), nullptr);
    EXPECT_NE(oracle.geometry(0).find(5), nullptr);
    EXPECT_EQ(oracle.geometry(0).find(6), nullptr);
}

TEST(Oracle, DuplicatesAnswerWithTheLowestInstanceThenPrimitive) {
    Soup soup;
    for (int i = 0; i < 40; ++i) soup.add({0, 0, 4}, {1, 0, 4}, {1, 1, 4});
    const Oracle oracle = oracle_of({soup}, {{0, Transform::translation({0, 0, 1}), 0}, {}, {}});
    const OracleHit hit = oracle.closest_hit(make_ray({0.7f, 0.2f, 0}, {0, 0, 1}));
    EXPECT_EQ(hit.primitive, 0u);
    EXPECT_EQ(hit.instance, 1u);
}

TEST(Oracle, HandsTheCustomIndexThrough) {
    const Oracle oracle = oracle_of({cube()}, {{0, Transform::translation({0, 0, 5}), 16777215}});
    EXPECT_EQ(oracle.closest_hit(make_ray({0.5f, 0.3f, 0}, {0, 0, 1})).custom_index, 16777215u);
}

TEST(Oracle, EmptyScenesMiss) {
    Soup all_degenerate;
    all_degenerate.add(vec3(1), vec3(1), vec3(2));
    const Ray ray = make_ray(vec3(0), vec3(1));
    for (const Oracle& oracle : {oracle_of({}, {}), oracle_of({Soup{}}, {{}}), oracle_of(all_degenerate)}) {
        EXPECT_FALSE(oracle.closest_hit(ray).hit);
        EXPECT_FALSE(oracle.closest_hit_brute_force(ray).hit);
        EXPECT_FALSE(oracle.any_hit(ray));
    }
}

TEST(Oracle, WorksAtTheEndsOfFloat32) {
    for (const float scale : {1e-38f, 1e-20f, 1e20f, 1e37f}) {
        Soup soup = sphere(2);
        for (vec3& p : soup.positions) p *= scale;
        const Oracle oracle = oracle_of(soup);
        for (const vec3& p : soup.positions) {
            const OracleHit hit = oracle.closest_hit(make_ray(vec3(0), p));
            EXPECT_TRUE(hit.hit) << scale;
            EXPECT_NEAR(hit.t, 1, 1e-6) << scale;
        }
    }
}

TEST(Oracle, ListsTheInstancesThatARayHitsBeforeALimit) {
    std::vector<OracleInstance> instances;
    for (int i = 0; i < 9; ++i) instances.push_back({0, Transform::translation({0, 0, 20.0f - 2.0f * float(i)}), 0});
    const Oracle oracle = oracle_of({cube()}, instances);
    const Ray ray = make_ray({0.5f, 0.3f, 0}, {0, 0, 1});
    EXPECT_EQ(oracle.instances_hit(ray, INFINITY).size(), 9u);
    EXPECT_EQ(oracle.instances_hit(ray, 8.5), (std::vector<uint>{6, 7, 8}));
    EXPECT_EQ(oracle.instances_hit(ray, 8.0), (std::vector<uint>{7, 8}));
}

TEST(Oracle, WrongInputIsNamed) {
    Soup soup = cube();
    soup.triangles[3].y = 8;
    const auto message = [](const auto& make) -> std::string {
        try {
            make();
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(message([&] { oracle_of(soup); }), "mesh 'test': triangle 3 uses vertex 8 of 8");
    EXPECT_EQ(message([] { oracle_of({cube()}, {{}, {1, {}, 0}}); }), "instance 1: geometry 1 of 1");
    EXPECT_NE(message([] { oracle_of({cube()}, {{0, Transform::scaling({1, 0, 1}), 0}}); }).find("instance 0"),
              std::string::npos);
}

TEST(Oracle, OfASceneFollowsItsInstances) {
    Scene scene;
    const Soup soup = cube();
    Mesh mesh;
    mesh.positions = soup.positions;
    mesh.triangles = soup.triangles;
    scene.meshes = {Mesh{}, mesh};
    scene.instances = {{"empty", 0, {}}, {"cube", 1, Transform::translation({0, 0, 5})}};
    const OracleHit hit = Oracle::of(scene).closest_hit(make_ray({0.5f, 0.3f, 0}, {0, 0, 1}));
    EXPECT_EQ(hit.t, 5);
    EXPECT_EQ(hit.instance, 1u);
}

}  // namespace
}  // namespace twinray
