// SPDX-License-Identifier: MIT
#include <cstring>

#include "bench/rays.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"

namespace twinray::bench {
namespace {

class MakeRays : public test::VulkanTest {};

bool are_equal(const std::vector<Ray>& a, const std::vector<Ray>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Ray)) == 0;
}

TEST_F(MakeRays, GivesSetsOfTheSameSizeThatAreTheSameAgain) {
    for (const char* name : {"sphere:500", "soup:200", "instances:8x80"}) {
        SCOPED_TRACE(name);
        const BenchScene scene = make_scene(name);
        const auto sets = make_rays(context(), scene, 32, 1), again = make_rays(context(), scene, 32, 1),
                   others = make_rays(context(), scene, 32, 2);
        for (std::size_t kind = 0; kind < sets.size(); ++kind) {
            EXPECT_EQ(sets[kind].size(), 32u * 32u);
            for (const Ray& ray : sets[kind]) ASSERT_TRUE(is_traceable(ray));
            EXPECT_TRUE(are_equal(sets[kind], again[kind]));
            EXPECT_EQ(are_equal(sets[kind], others[kind]), kind == 0);  // a camera has no seed
        }
    }
}

TEST_F(MakeRays, ShufflesTheIncoherentOnes) {
    const auto sets = make_rays(context(), make_scene("sphere:500"), 32, 1);
    const std::vector<Ray>& incoherent = sets[static_cast<std::size_t>(RayKind::incoherent)];
    EXPECT_TRUE(are_equal(sets[static_cast<std::size_t>(RayKind::shuffled)], shuffled_rays(incoherent, 1)));
}

TEST_F(MakeRays, SaysWhenNoneMeetsTheScene) {
    BenchScene scene = make_scene("sphere:20");
    scene.framed = {vec3(100), vec3(101)};
    test::expect_contains(test::error_of([&] { make_rays(context(), scene, 8, 1); }),
                          "scene 'sphere:20': none of 64 primary rays meets it");
}

}  // namespace
}  // namespace twinray::bench
