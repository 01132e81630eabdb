// SPDX-License-Identifier: MIT
#include "validation/reference/aimed_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/validation/reference/meshes.h"

namespace twinray {
namespace {

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
