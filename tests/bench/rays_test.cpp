// SPDX-License-Identifier: MIT
#include "bench/rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "validation/reference/aimed_rays.h"
#include "validation/reference/reference_scene.h"
#include "report/suite/case_run.h"

namespace twinray::bench {
namespace {

// A convex shape, turned, stretched and far from the origin, with its primary rays and where they meet it.
struct Convex {
    Scene scene;
    ReferenceScene reference;
    std::vector<Ray> primary;
    std::vector<Surface> points;
};

Scene ball() {
    Scene scene;
    scene.meshes.push_back(make_icosphere(3));
    const Transform placed = Transform::translation({30, -20, 10}) * Transform::scaling({1, 2, -0.5f});
    scene.instances.push_back({"ball", 0, placed});
    return scene;
}

Convex convex() {
    Scene scene = ball();
    ReferenceScene reference = ReferenceScene::of(scene);
    std::vector<Ray> primary = primary_rays(bounds_of(scene), 64);
    std::vector<Hit> hits;
    for (const Ray& ray : primary) {
        const ReferenceHit found = reference.closest_hit(ray);
        Hit hit = miss();
        hit.hit = found.hit;
        hit.primitive_index = found.primitive;
        hit.u = static_cast<float>(found.u);
        hit.v = static_cast<float>(found.v);
        hits.push_back(hit);
    }
    std::vector<Surface> points = surfaces_of(scene, primary, hits);
    return {std::move(scene), std::move(reference), std::move(primary), std::move(points)};
}

void expect_traceable(const Ray& ray) {
    ASSERT_TRUE(is_traceable(ray));
    ASSERT_EQ(ray.t_min, 0);
    ASSERT_NEAR(length(ray.direction), 1, 1e-6);
}

// Expects rays from the points in order, each point as often as any other within one.
void expect_order(const std::vector<Ray>& rays, const std::vector<Surface>& points) {
    std::vector<std::size_t> uses(points.size());
    std::size_t at = 0;
    for (const Ray& ray : rays) {
        while (at < points.size() && ray.origin != points[at].front && ray.origin != points[at].back) ++at;
        ASSERT_LT(at, points.size()) << "a ray starts at no point, or at one of before";
        ++uses[at];
    }
    const auto [least, most] = std::minmax_element(uses.begin(), uses.end());
    EXPECT_LE(*most, *least + 1);
}

TEST(BenchRays, PointsLieWhereRaysMetTheScene) {
    const Convex shape = convex();
    std::size_t hits = 0;
    for (const Ray& ray : shape.primary) hits += shape.reference.closest_hit(ray).hit;
    ASSERT_GT(hits, 500u);
    ASSERT_EQ(shape.points.size(), hits);
    for (const Surface& point : shape.points) {
        ASSERT_TRUE(point.is_front);  // seen from outside, whatever the mirror
        ASSERT_GT(dot(point.normal, point.front - vec3(30, -20, 10)), 0);
        ASSERT_GT(dot(point.normal, point.front - point.back), 0);
        ASSERT_LT(length(point.front - point.back), 1e-4f);
    }
}

// Outside a convex shape, no ray into the outer hemisphere meets it again, unless it starts wrong.
TEST(BenchRays, IncoherentRaysLeaveTheSurface) {
    const Convex shape = convex();
    const std::vector<Ray> rays = incoherent_rays(shape.points, 5000, 3);
    ASSERT_EQ(rays.size(), 5000u);
    expect_order(rays, shape.points);
    for (const Ray& ray : rays) {
        expect_traceable(ray);
        EXPECT_EQ(ray.t_max, INFINITY);
        ASSERT_FALSE(shape.reference.any_hit(ray));
    }
}

TEST(BenchRays, IncoherentRaysFillTheHemisphereEvenly) {
    const Surface point{vec3(0), vec3(0), vec3(0, 0, 1), true};
    double height = 0;
    vec3 sum(0);
    const std::vector<Ray> rays = incoherent_rays({&point, 1}, 20'000, 5);
    for (const Ray& ray : rays) {
        ASSERT_GE(ray.direction.z, 0);
        height += double(ray.direction.z) / 20'000;
        sum += ray.direction / 20'000.0f;
    }
    EXPECT_NEAR(height, 0.5, 0.01);  // uniform over solid angle; 3/4 were cosine-weighted's 2/3
    EXPECT_NEAR(sum.x, 0, 0.02);
    EXPECT_NEAR(sum.y, 0, 0.02);
}

TEST(BenchRays, OcclusionRaysEndJustBeforeALightOutside) {
    const Convex shape = convex();
    const Bounds bounds = bounds_of(shape.scene);
    const std::vector<Ray> rays = occlusion_rays(shape.points, bounds, 5000, 3);
    ASSERT_EQ(rays.size(), 5000u);
    expect_order(rays, shape.points);
    Bounds ends;
    std::size_t lit = 0;
    for (const Ray& ray : rays) {
        expect_traceable(ray);
        ends.include(ray.origin + ray.direction * ray.t_max);
        lit += !shape.reference.any_hit(ray);
    }
    EXPECT_GT(ends.lo.y, bounds.hi.y);
    EXPECT_LT(length(ends.size()), length(bounds.size()));
    EXPECT_GT(lit, 500u);
    EXPECT_LT(lit, 4500u);
}

TEST(BenchRays, ShuffledRaysAreTheSameInEveryOrder) {
    std::vector<Ray> rays(5);
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i].t_max = static_cast<float>(i);
    const auto order = [&](std::uint64_t seed) {
        std::vector<float> numbers;
        for (const Ray& ray : shuffled_rays(rays, seed)) numbers.push_back(ray.t_max);
        return numbers;
    };
    std::map<std::vector<float>, int> orders;
    for (std::uint64_t seed = 0; seed < 12'000; ++seed) ++orders[order(seed)];
    EXPECT_EQ(orders.size(), 120u);
    for (const auto& [numbers, count] : orders) {
        EXPECT_NEAR(count, 100, 50);
        std::vector<float> back = numbers;
        std::sort(back.begin(), back.end());
        ASSERT_EQ(back, (std::vector<float>{0, 1, 2, 3, 4}));
    }
    EXPECT_EQ(order(7), order(7));
    EXPECT_TRUE(shuffled_rays({}, 1).empty());
}

TEST(BenchRays, DependOnTheSeedAlone) {
    const Convex shape = convex();
    const auto origins_and_directions = [&](std::uint64_t seed) {
        std::vector<vec3> all;
        for (const auto& rays : {incoherent_rays(shape.points, 100, seed),
                                 occlusion_rays(shape.points, bounds_of(shape.scene), 100, seed)})
            for (const Ray& ray : rays) all.insert(all.end(), {ray.origin, ray.direction});
        return all;
    };
    EXPECT_EQ(origins_and_directions(1), origins_and_directions(1));
    EXPECT_NE(origins_and_directions(1), origins_and_directions(2));
}

}  // namespace
}  // namespace twinray::bench
