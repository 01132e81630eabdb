// SPDX-License-Identifier: MIT
// Traversal on devices that flush denormals, which the CPU plays.
#include "validation/suite/flush.h"

#include <gtest/gtest.h>

#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "validation/reference/aimed_rays.h"
#include "tests/support/device.h"
#include "validation/suite/twin.h"

namespace twinray::suite {
namespace {

std::size_t hit_count(const std::vector<Hit>& hits) {
    std::size_t count = 0;
    for (const Hit& hit : hits) count += hit.hit;
    return count;
}

// t is 1e-36 and its products with the steps of compressed boxes are denormal: they are taken times a power of two.
TEST(FlushedDenormals, LongDirectionsLoseNothing) {
    if (!FlushDenormals::is_able()) TWINRAY_LACKS("flushed_denormals", "this processor cannot");
    Scene scene;
    scene.meshes = {make_icosphere(3)};
    scene.instances = {{"", 0, {}}};
    const std::unique_ptr<reference::Scene> on_cpu = twin_of(scene);
    std::vector<Ray> rays = random_rays({vec3(-1), vec3(1)}, 4096, 1);
    for (Ray& ray : rays) ray.direction = normalize(ray.direction);
    const std::size_t expected = hit_count(trace_twin(*on_cpu, rays, Level::watertight));
    EXPECT_GT(expected, 500u);
    for (const float length : {1e-30f, 1e30f, 1e36f}) {
        std::vector<Ray> stretched = rays;
        for (Ray& ray : stretched) ray.direction *= length;
        const std::size_t found = hit_count(trace_twin(*on_cpu, stretched, Level::watertight, Denormals::flushed));
        EXPECT_GE(found + expected / 100, expected) << length;  // those nearer than 0.01 have a denormal t themselves
    }
}

}  // namespace
}  // namespace twinray::suite
