// SPDX-License-Identifier: MIT
#include "report/reproducer/page.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/scene/temp_dir.h"

namespace twinray::reproducer {
namespace {

// Two triangles of a square, which a ray on their common edge misses.
Reproduction leak() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    Reproduction found;
    found.scene.meshes = {mesh};
    found.scene.instances = {{"", 0, Transform{}}};
    found.ray = {vec3(0.5f, 0.5f, 2), 0, vec3(0, 0, -1), std::numeric_limits<float>::infinity()};
    found.backend = suite::Backend::ray_query;
    found.kind = HitClass::hw_leak;
    found.answer = miss();
    found.right.exact = "triangle 0 of instance 0 at t = 2";
    found.triangles_before = 128;
    return found;
}

std::string page_of(const Reproduction& found) {
    replay::Replay replay;
    replay.device = "a device";
    replay.driver = "a driver 1.2";
    replay.kind = name_of(found.kind);
    return page_text(found, replay);
}

TEST(Page, TellsWhatATrackerWants) {
    const std::string page = page_of(leak());
    for (const char* part :
         {"# a device: a ray passes through triangles", "driver: a driver 1.2", "a ray query (`VK_KHR_ray_query`)",
          "expected: triangle 0 of instance 0 at t = 2", "answered: a miss", "0x1p-1 0x1p-1 0x1p+1 0x0p+0",
          "| 0 | 1 | (0, 0, 0) (1, 1, 0) (0, 1, 0.100000001) |", "reduced from 128 triangles.", "This is a *should*",
          "./reproducer DEVICE pipeline"})
        test::expect_contains(page, part);
    EXPECT_EQ(page.find("winding is not equal"), std::string::npos);
    EXPECT_EQ(page.find("has the transform"), std::string::npos);
}

TEST(Page, SaysWhereVulkanPromisesNothing) {
    Reproduction turned = leak();
    std::swap(turned.scene.meshes[0].triangles[1].y, turned.scene.meshes[0].triangles[1].z);
    test::expect_contains(page_of(turned), "their winding is not equal");
    Reproduction far = leak();
    far.kind = HitClass::hw_t_err;
    far.answer = {1, 2.5f, 1, 0, 0.25f, 0.5f, 0, 0};
    far.scene.instances[0].transform = Transform::scaling(vec3(2));
    far.was_cut_short = true;
    const std::string page = page_of(far);
    for (const char* part : {"answered: triangle 1 of instance 0 at t = 2.5, u = 0.25, v = 0.5", "states no precision",
                             "Instance 0 has the transform, row by row (2, 0, 0, 0)", "it may not be the smallest"})
        test::expect_contains(page, part);
}

}  // namespace
}  // namespace twinray::reproducer
