// SPDX-License-Identifier: MIT
// The classifier against model accelerators: rounding alone is never a fault, a leaking test always is.
#include "tests/validation/reference/float32_kernels.h"

#include <gtest/gtest.h>

#include "validation/reference/aimed_rays.h"
#include "validation/reference/classify.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

struct Tally {
    HitClassCounts software, hardware;
};

// Random and aimed rays against one kernel as both accelerators, and against its refined level.
Tally tally(const Scene32& scene, Test32 test, std::size_t count, std::uint64_t seed) {
    const ReferenceScene reference = scene.reference();
    const Bounds bounds{vec3(reference.bounds().corners[0]), vec3(reference.bounds().corners[1])};
    std::vector<Ray> rays = random_rays(bounds, count, seed);
    for (const auto& more : {vertex_aimed_rays(reference, count, seed), edge_aimed_rays(reference, count, seed)})
        rays.insert(rays.end(), more.begin(), more.end());
    std::vector<Hit> hits;
    for (const Ray& ray : rays) hits.push_back(scene.trace(ray, test));
    Tally result;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const RayResult ray_result = classify(reference, rays[i], hits[i], hits[i]);
        result.software.add(*ray_result.software);
        result.hardware.add(*ray_result.hardware);
        result.software.add(*classify(reference, rays[i], refined(reference, rays[i], hits[i]), {}).software);
        const RayResult any = classify_any(reference, rays[i], hits[i].hit != 0, hits[i].hit != 0);
        result.software.add(*any.software);
        result.hardware.add(*any.hardware);
    }
    return result;
}

void expect_no_fault(const Scene32& scene, std::uint64_t seed) {
    const Tally result = tally(scene, watertight32, 1500, seed);
    EXPECT_EQ(result.software.faults_of_ours(), 0u) << "seed " << seed;
    for (std::size_t i = 0; i < hit_class_count; ++i) {
        const HitClass kind = static_cast<HitClass>(i);
        const bool is_wrong = is_fault_of_ours(kind) || kind == HitClass::hw_leak || kind == HitClass::hw_false ||
                              kind == HitClass::hw_t_err || kind == HitClass::hw_range;
        if (is_wrong) {
            EXPECT_EQ(result.software[kind] + result.hardware[kind], 0u) << name_of(kind) << ", seed " << seed;
        }
    }
    EXPECT_GT(result.software[HitClass::agree], result.software.total() / 4) << "seed " << seed;
}

Soup slivers(std::uint32_t seed, float width) {
    std::mt19937 random(seed);
    Soup soup;
    for (int i = 0; i < 300; ++i) {
        const vec3 a = uniform3(random, -1, 1);
        const vec3 b = uniform3(random, -1, 1);
        soup.add(a, b, mix(a, b, uniform(random, 0, 1)) + width * uniform3(random, -1, 1));
    }
    return soup;
}

TEST(HonestKernel, HasNoFaultOnSoups) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        expect_no_fault(one(random_soup(300, 0.5f, seed)), seed);
        expect_no_fault(one(random_soup(300, 0.02f, seed)), seed);
    }
}

TEST(HonestKernel, HasNoFaultOnGridsAndClosedMeshes) {
    expect_no_fault(one(grid(14, 0, 0, 1)), 11);
    expect_no_fault(one(grid(14, 0.3f, 0.3f, 1)), 12);
    expect_no_fault(one(sphere(3)), 13);
    expect_no_fault(one(cube()), 14);
}

TEST(HonestKernel, HasNoFaultOnSlivers) {
    for (const float width : {1e-2f, 1e-4f, 1e-6f})
        for (std::uint32_t seed = 1; seed <= 3; ++seed) expect_no_fault(one(slivers(seed, width)), seed);
}

TEST(HonestKernel, HasNoFaultFarFromTheOrigin) {
    Soup far = grid(14, 0.3f, 0.3f, 1);
    for (vec3& p : far.positions) p += vec3(1e5f, -1e5f, 1e5f);
    expect_no_fault(one(far), 31);
    expect_no_fault(one(sphere(3), Transform::translation({1e4f, -1e4f, 1e4f}) * rotation(0.7f, 0.4f)), 32);
}

TEST(HonestKernel, HasNoFaultUnderTransforms) {
    const Transform turned = rotation(0.7f, 0.4f);
    expect_no_fault(one(sphere(3), turned), 41);
    expect_no_fault(one(sphere(3), turned * Transform::scaling({-1, 30, 0.02f})), 42);
    const Scene32 many = {{sphere(2), cube(), grid(8, 0, 0, 1)},
                          {{0, turned, 0},
                           {1, Transform::translation({1, 0, 0}), 0},
                           {1, {}, 0},
                           {2, turned, 0},
                           {0, Transform::translation({0, 3, 1}) * Transform::scaling({2, 2, 2}), 0}}};
    expect_no_fault(many, 43);
}

TEST(LeakyKernel, IsCaughtAtTheSharedEdgesOfAClosedMesh) {
    const std::uint32_t seed = 51;
    const Scene32 scene = one(sphere(3));
    const ReferenceScene reference = scene.reference();
    std::size_t misses = 0;
    for (const Ray& ray : rays_from_inside(scene.soups[0], {}, 10000, seed)) {
        const Hit hit = scene.trace(ray, leaky32);
        const HitClass kind = *classify(reference, ray, hit, {}).software;
        misses += hit.hit == 0;
        ASSERT_EQ(kind == HitClass::sw_leak, hit.hit == 0) << name_of(kind) << ", seed " << seed;
    }
    EXPECT_GT(misses, 100u) << "seed " << seed;
}

}  // namespace
}  // namespace twinray
