// The reference of float64, and rays for it: random ones, and those that are aimed at vertices and edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/scene/temp_dir.h"
#include "tests/validation/reference/meshes.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/reference_scene.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

// One sheet: z = 4 over the unit square.
ReferenceScene plane_at_4() {
    Soup soup;
    soup.add({0, 0, 4}, {1, 0, 4}, {1, 1, 4});
    soup.add({0, 0, 4}, {1, 1, 4}, {0, 1, 4});
    return reference_of(soup);
}

TEST(ReferenceScene, FindsWhatAPlainPlaneEquationFinds) {
    const std::uint32_t seed = 61;
    const Soup soup = random_soup(50, 0.5f, seed);
    const ReferenceScene reference = reference_of(soup);
    for (const Ray& ray : random_rays({vec3(-1), vec3(1)}, 2000, seed)) {
        double best = INFINITY;
        const dvec3 o(ray.origin), d(ray.direction);
        for (const uvec3& index : soup.triangles) {
            const dvec3 a(soup.positions[index.x]), b(soup.positions[index.y]), c(soup.positions[index.z]);
            const dvec3 n = cross(b - a, c - a);
            const double t = dot(a - o, n) / dot(d, n);
            const dvec3 p = o + t * d;
            const bool is_inside = dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                                   dot(cross(a - c, p - c), n) >= 0;
            if (is_inside && t > 0) best = std::min(best, t);
        }
        const ReferenceHit hit = reference.closest_hit(ray);
        ASSERT_EQ(hit.hit, best < INFINITY) << "seed " << seed;
        if (!hit.hit) continue;
        ASSERT_NEAR(hit.t, best, 1e-10 * best) << "seed " << seed;
        const uvec3 index = soup.triangles[hit.primitive];
        const dvec3 point = (1 - hit.u - hit.v) * dvec3(soup.positions[index.x]) +
                            hit.u * dvec3(soup.positions[index.y]) + hit.v * dvec3(soup.positions[index.z]);
        ASSERT_LT(length(point - (o + hit.t * d)), 1e-10) << "seed " << seed;
    }
}

TEST(ReferenceScene, ClosedMeshesNeverLeakFromInside) {
    const std::uint32_t seed = 71;
    const Soup soup = sphere(4);
    for (const Transform& transform : {Transform{}, rotation(0.5f, 0.3f) * Transform::scaling({3, 1, 0.2f})}) {
        const ReferenceScene reference = reference_of({soup}, {{0, transform, 0}});
        for (const Ray& ray : rays_from_inside(soup, transform, 40000, seed))
            ASSERT_TRUE(reference.closest_hit(ray).hit) << "seed " << seed;
    }
}

TEST(ReferenceScene, NegativeTMinCountsAsZero) {
    const ReferenceScene reference = plane_at_4();
    EXPECT_FALSE(reference.any_hit(make_ray({0.7f, 0.2f, 5}, {0, 0, 1}, -10)));
    EXPECT_FALSE(reference.any_hit(make_ray({0.7f, 0.2f, 4}, {0, 0, 1}, -10)));
    EXPECT_TRUE(reference.any_hit(make_ray({0.7f, 0.2f, 3}, {0, 0, 1}, -10)));
}

TEST(ReferenceScene, RaysThatVulkanForbidsMiss) {
    const ReferenceScene reference = plane_at_4();
    const vec3 o(0.7f, 0.2f, 0), z(0, 0, 1);
    for (const Ray& ray : {make_ray(o, vec3(0)), make_ray({NAN, 0, 0}, z), make_ray(o, {0, INFINITY, 1}),
                           make_ray(o, z, NAN), make_ray(o, z, 0, NAN), make_ray(o, z, 5, 3), make_ray(o, z, 0, -1)}) {
        EXPECT_FALSE(reference.closest_hit(ray).hit);
        EXPECT_FALSE(reference.closest_hit_brute_force(ray).hit);
        EXPECT_FALSE(reference.any_hit(ray));
        EXPECT_TRUE(reference.instances_hit(ray, INFINITY).empty());
    }
}

TEST(ReferenceScene, NonFiniteAndDegenerateTrianglesAreNeverHit) {
    Soup soup;
    soup.add({0, 0, 1}, {1, 0, 1}, {NAN, 1, 1});
    soup.add({0, 0, 1}, {1, 0, 1}, {1, INFINITY, 1});
    soup.add({0, 0, 1}, {1, 0, 1}, {1, 0, 1});
    soup.add({0, 0, 1}, {0.25f, 0.125f, 1}, {1, 0.5f, 1});  // on a line
    soup.add({0, 0, 1}, {0.1f, 0.3f, 1}, {0.7f, 2.1f, 1});  // not quite: rounded coordinates
    soup.add({0, 0, 4}, {1, 0, 4}, {1, 1, 4});
    const ReferenceScene reference = reference_of(soup);
    const ReferenceHit hit = reference.closest_hit(make_ray({0.25f, 0.125f, 0}, {0, 0, 1}));
    EXPECT_EQ(hit.primitive, 5u);
    EXPECT_EQ(hit.t, 4);
    for (const uint inactive : {0u, 1u, 2u, 3u}) EXPECT_EQ(reference.geometry(0).find(inactive), nullptr) << inactive;
    EXPECT_NE(reference.geometry(0).find(4), nullptr);
    EXPECT_NE(reference.geometry(0).find(5), nullptr);
    EXPECT_EQ(reference.geometry(0).find(6), nullptr);
}

TEST(ReferenceScene, EmptyScenesMiss) {
    Soup all_degenerate;
    all_degenerate.add(vec3(1), vec3(1), vec3(2));
    const Ray ray = make_ray(vec3(0), vec3(1));
    for (const ReferenceScene& reference :
         {reference_of(std::vector<Soup>{}, {}), reference_of(Soup{}), reference_of(all_degenerate)}) {
        EXPECT_FALSE(reference.closest_hit(ray).hit);
        EXPECT_FALSE(reference.closest_hit_brute_force(ray).hit);
        EXPECT_FALSE(reference.any_hit(ray));
    }
}

TEST(ReferenceScene, WorksAtTheEndsOfFloat32) {
    for (const float scale : {1e-38f, 1e-20f, 1e20f, 1e37f}) {
        Soup soup = sphere(2);
        for (vec3& p : soup.positions) p *= scale;
        const ReferenceScene reference = reference_of(soup);
        for (const vec3& p : soup.positions) {
            const ReferenceHit hit = reference.closest_hit(make_ray(vec3(0), p));
            EXPECT_TRUE(hit.hit) << scale;
            EXPECT_NEAR(hit.t, 1, 1e-6) << scale;
        }
    }
}

TEST(ReferenceScene, ListsTheInstancesThatARayHitsBeforeALimit) {
    std::vector<ReferenceInstance> instances;
    for (int i = 0; i < 9; ++i) instances.push_back({0, Transform::translation({0, 0, 20.0f - 2.0f * float(i)}), 0});
    const ReferenceScene reference = reference_of({cube()}, instances);
    const Ray ray = make_ray({0.5f, 0.3f, 0}, {0, 0, 1});
    EXPECT_EQ(reference.instances_hit(ray, INFINITY).size(), 9u);
    EXPECT_EQ(reference.instances_hit(ray, 8.5), (std::vector<uint>{6, 7, 8}));
    EXPECT_EQ(reference.instances_hit(ray, 8.0), (std::vector<uint>{7, 8}));
}

TEST(ReferenceScene, MasksLeaveInstancesOut) {
    const ReferenceScene reference =
        reference_of({cube()}, {{0, {}, {.custom_index = 1, .mask = 0x0f}},
                                {0, Transform::translation({0, 0, 4}), {.custom_index = 2, .mask = 0x30}},
                                {0, Transform::translation({0, 0, -4}), {.mask = 0}}});
    const Ray ray = make_ray({0.5f, 0.3f, -9}, {0, 0, 1});
    EXPECT_EQ(reference.closest_hit(ray).custom_index, 1u);
    EXPECT_EQ(reference.closest_hit(ray, {.mask = 0x18}).custom_index, 1u);
    EXPECT_EQ(reference.closest_hit(ray, {.mask = 0x10}).custom_index, 2u);
    EXPECT_FALSE(reference.closest_hit(ray, {.mask = 0xc0}).hit);
    EXPECT_FALSE(reference.any_hit(ray, {.mask = 0xc0}));
}

// The hit after culling equals that of a search over all triangles of the side that faces the ray.
TEST(ReferenceScene, CullingKeepsTheTrianglesWhoseNormalTellsSo) {
    const std::uint32_t seed = 81;
    const Soup soup = random_soup(300, 0.5f, seed);
    const ReferenceScene all = reference_of(soup);
    std::size_t hits = 0;
    for (const Ray& ray : random_rays({vec3(-1), vec3(1)}, 200, seed)) {
        Soup sides[2];  // shows the front, the back
        std::vector<uint> kept[2];
        for (uint i = 0; i < soup.triangles.size(); ++i) {
            const uvec3 t = soup.triangles[i];
            const dvec3 a(soup.positions[t.x]), b(soup.positions[t.y]), c(soup.positions[t.z]);
            const bool is_back = dot(cross(b - a, c - a), dvec3(ray.direction)) > 0;
            sides[is_back].positions = soup.positions;
            sides[is_back].triangles.push_back(t);
            kept[is_back].push_back(i);
        }
        for (const bool cull_back : {false, true}) {
            const ReferenceHit expected = reference_of(sides[!cull_back]).closest_hit_brute_force(ray);
            const ReferenceHit found = all.closest_hit(ray, {.flags = cull_back ? CULL_BACK : CULL_FRONT});
            ASSERT_EQ(found.hit, expected.hit) << "seed " << seed;
            if (!found.hit) continue;
            ASSERT_EQ(found.t, expected.t);
            ASSERT_EQ(found.primitive, kept[!cull_back][expected.primitive]);
            ++hits;
        }
    }
    EXPECT_GT(hits, 50u);
}

TEST(ReferenceScene, WrongInputIsNamed) {
    Soup soup = cube();
    soup.triangles[3].y = 8;
    EXPECT_EQ(error_of([&] { reference_of(soup); }),
              "mesh 'test': triangle 3 has vertex index 8, but the mesh has only 8 vertices");
    EXPECT_EQ(error_of([] { reference_of({cube()}, {{}, {1, {}, 0}}); }), "instance 1: geometry 1 of 1");
    expect_error("instance 0", [] { reference_of({cube()}, {{0, Transform::scaling({1, 0, 1}), 0}}); });
}

TEST(ReferenceScene, OfASceneFollowsItsInstances) {
    Scene scene;
    const Soup soup = cube();
    Mesh mesh;
    mesh.positions = soup.positions;
    mesh.triangles = soup.triangles;
    scene.meshes = {Mesh{}, mesh};
    scene.instances = {{"empty", 0, {}}, {"cube", 1, Transform::translation({0, 0, 5})}};
    const ReferenceHit hit = ReferenceScene::of(scene).closest_hit(make_ray({0.5f, 0.3f, 0}, {0, 0, 1}));
    EXPECT_EQ(hit.t, 5);
    EXPECT_EQ(hit.instance, 1u);
}

using namespace test;  // NOLINT

constexpr std::uint64_t aim_seed = 2026;

bool same_bytes(const Ray& a, const Ray& b) { return std::memcmp(&a, &b, sizeof(Ray)) == 0; }

void expect_valid(const std::vector<Ray>& rays) {
    for (const Ray& ray : rays) {
        ASSERT_TRUE(is_traceable(ray));
        ASSERT_NEAR(length(ray.direction), 1, 1e-6);
        ASSERT_EQ(ray.t_min, 0);
        ASSERT_EQ(ray.t_max, INFINITY);
    }
}

TEST(AimedRays, RayIDependsOnlyOnSeedAndIndex) {
    const ReferenceScene reference = reference_of(sphere(2));
    const auto check = [](const auto& make) {
        const std::vector<Ray> few = make(10, aim_seed), many = make(100, aim_seed), other = make(10, aim_seed + 1);
        for (std::size_t i = 0; i < few.size(); ++i) {
            EXPECT_TRUE(same_bytes(few[i], many[i])) << i;
            EXPECT_FALSE(same_bytes(few[i], other[i])) << i;
            EXPECT_FALSE(same_bytes(few[i], few[(i + 1) % few.size()])) << i;
        }
    };
    check([](std::size_t n, std::uint64_t s) { return random_rays({vec3(-1), vec3(1)}, n, s); });
    check([&](std::size_t n, std::uint64_t s) { return vertex_aimed_rays(reference, n, s); });
    check([&](std::size_t n, std::uint64_t s) { return edge_aimed_rays(reference, n, s); });
}

TEST(AimedRays, BytesOfTheFirstRayAreFrozen) {
    const Ray ray = random_rays({vec3(-1), vec3(1)}, 1, aim_seed)[0];
    const std::array<float, 6> values = {ray.origin.x,    ray.origin.y,    ray.origin.z,
                                         ray.direction.x, ray.direction.y, ray.direction.z};
    const std::array<float, 6> expected = {-0x1.f3c992p-1f, -0x1.c22ffcp-1f, -0x1.fe518p-2f,
                                           -0x1.b80178p-5f, 0x1.f71238p-1f,  0x1.6c92fcp-3f};
    EXPECT_EQ(values, expected);
}

TEST(AimedRays, RandomRaysStartInAndAroundTheBoxAndPointEverywhere) {
    const Bounds box{vec3(1, 2, 3), vec3(2, 4, 6)};
    const std::vector<Ray> rays = random_rays(box, 20000, aim_seed);
    expect_valid(rays);
    dvec3 sum(0.0), squares(0.0);
    std::size_t inside = 0;
    for (const Ray& ray : rays) {
        sum += dvec3(ray.direction);
        squares += dvec3(ray.direction * ray.direction);
        inside += ray.origin == clamp(ray.origin, box.lo, box.hi);
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(sum[axis] / 20000, 0, 0.02) << "aim_seed " << aim_seed;  // 5 standard deviations of 1/sqrt(3n)
        EXPECT_NEAR(squares[axis] / 20000, 1.0 / 3, 0.011) << "aim_seed " << aim_seed;
    }
    EXPECT_GT(inside, 2000u) << "aim_seed " << aim_seed;
    EXPECT_LT(inside, 18000u) << "aim_seed " << aim_seed;
}

TEST(AimedRays, VertexAimedRaysPassAVertexWithinRounding) {
    const Soup soup = sphere(2);
    const Transform transform = Transform::translation({3, 4, 5}) * rotation(0.3f, 0.8f);
    const ReferenceScene reference = reference_of(soup, transform);
    const std::vector<Ray> rays = vertex_aimed_rays(reference, 500, aim_seed);
    expect_valid(rays);
    const Placement64& placement = reference.placement(0);
    for (const Ray& ray : rays) {
        double nearest = INFINITY;
        for (const vec3& p : soup.positions)
            nearest = std::min(nearest, distance_to_line(placement.to_world * dvec3(p) + placement.offset, ray));
        ASSERT_LT(nearest, 1e-6) << "aim_seed " << aim_seed;
    }
}

TEST(AimedRays, EdgeAimedRaysPassAnEdgeAndHitEitherSide) {
    const Soup soup = grid(10, 0.2f, 0, 3);
    const ReferenceScene reference = reference_of(soup);
    const std::vector<Ray> rays = edge_aimed_rays(reference, 2000, aim_seed);
    expect_valid(rays);
    std::size_t at_edges = 0, hits = 0;
    for (const Ray& ray : rays) {
        const ReferenceHit hit = reference.closest_hit(ray);
        if (!hit.hit) continue;  // past the rim
        ++hits;
        at_edges += std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < 1e-4;
    }
    EXPECT_GT(hits, 1700u) << "aim_seed " << aim_seed;
    EXPECT_GE(at_edges, hits * 99 / 100) << "aim_seed " << aim_seed;  // grazing rays may pass an edge elsewhere first
}

TEST(AimedRays, OriginsAreTwentiethToTwoDiagonalsAway) {
    Soup soup;
    soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const double diagonal = std::sqrt(2.0);
    for (const Ray& ray : vertex_aimed_rays(reference_of(soup), 500, aim_seed)) {
        double nearest = INFINITY;
        for (const vec3& p : soup.positions)
            if (distance_to_line(dvec3(p), ray) < 1e-6)
                nearest = std::min(nearest, length(dvec3(p) - dvec3(ray.origin)));
        ASSERT_LT(nearest, 2.01 * diagonal) << "aim_seed " << aim_seed;
        ASSERT_GT(nearest, 0.049 * diagonal) << "aim_seed " << aim_seed;
    }
}

TEST(AimedRays, ExtremeScenesGiveTraceableRays) {
    Soup far, huge, point_like, inactive;
    far.add(vec3(1e10f), {1e10f + 1024, 1e10f, 1e10f}, {1e10f, 1e10f + 1024, 1e10f});  // neighbours in float32
    huge.add({3e38f, 0, 0}, {0, 3e38f, 0}, {-3e38f, 0, 3e38f});
    point_like.add({0, 0, 0}, {1e-40f, 0, 0}, {0, 1e-40f, 0});
    inactive.add(vec3(NAN), vec3(0), vec3(1));
    for (const Soup& soup : {far, huge, point_like, inactive, Soup{}}) {
        expect_valid(vertex_aimed_rays(reference_of(soup), 200, aim_seed));
        expect_valid(edge_aimed_rays(reference_of(soup), 200, aim_seed));
        expect_valid(random_rays(soup.positions.empty() ? Bounds{} : Bounds{vec3(1), vec3(1)}, 200, aim_seed));
    }
}

TEST(AimedRays, InactiveTrianglesAreNotTargets) {
    Soup soup;
    for (int i = 0; i < 20; ++i) soup.add(vec3(NAN), vec3(9), vec3(8));
    soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    for (const Ray& ray : vertex_aimed_rays(reference_of(soup), 200, aim_seed)) {
        double nearest = INFINITY;
        for (std::size_t i = 60; i < 63; ++i)
            nearest = std::min(nearest, distance_to_line(dvec3(soup.positions[i]), ray));
        ASSERT_LT(nearest, 1e-6) << "aim_seed " << aim_seed;
    }
}

}  // namespace
}  // namespace twinray
