// SPDX-License-Identifier: MIT
// The public face of validation, used as a host would.
#include <twinray/validation.h>

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include <twinray/scene.h>
#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"

namespace {

using namespace twinray;

Scene two_spheres() {
    Scene scene;
    scene.meshes.push_back(make_icosphere(2));
    scene.instances = {{"a", 0, {}}, {"b", 0, Transform::translation({3, 0, 0})}};
    return scene;
}

class HostValidation : public test::VulkanTest {};

TEST_F(HostValidation, HitsOfAnAcceleratorAreCountedByClass) {
    const Scene scene = two_spheres();
    const Reference reference(scene);
    SwTlas accel(context());
    for (const Instance& instance : scene.instances) accel.push(scene.meshes[instance.mesh], instance.transform);
    for (const auto& rays : {random_rays(bounds_of(scene), 1'000, 1), vertex_aimed_rays(reference, 1'000, 1),
                             edge_aimed_rays(reference, 1'000, 1)}) {
        const HitClassCounts counts = count(reference.classify(rays, accel.closest_hits(rays), TracedBy::software));
        EXPECT_EQ(counts.total(), rays.size());
        EXPECT_EQ(counts.faults_of_ours(), 0u);
        EXPECT_GT(counts[HitClass::agree], rays.size() / 2);
        EXPECT_NEAR(counts.bound_95(), 3.0 / 1'000, 1e-4);
    }
}

TEST_F(HostValidation, WrongHitsAreFaults) {
    const Mesh quad = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    const MeshView view(quad);
    const ReferenceInstance moved{0, Transform::translation({0, 0, 2}), {}};
    const Reference reference(std::span(&view, 1), std::span(&moved, 1));
    const Ray ray{vec3(0.25f, 0.25f, 0), 0, vec3(0, 0, 1), 10};
    EXPECT_EQ(reference.closest_hit(ray).t, 2);
    EXPECT_TRUE(reference.any_hit(ray));
    const Hit missed{0, -1, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(name_of(reference.classify(ray, missed, TracedBy::software)), "SW_LEAK");
    EXPECT_EQ(reference.classify(ray, missed, TracedBy::hardware), HitClass::hw_leak);
    EXPECT_EQ(reference.classify_any(ray, false, TracedBy::software), HitClass::sw_leak);
    EXPECT_EQ(reference.classify_any(ray, true, TracedBy::hardware), HitClass::agree);
    EXPECT_THROW(reference.classify(std::span(&ray, 1), {}, TracedBy::software), Error);
    EXPECT_EQ(HitClassCounts().bound_95(), 1);
}

TEST_F(HostValidation, TheReferenceIsAnAccelerator) {
    const std::unique_ptr<AbstractAccel> accel = make_reference_accel(context());
    accel->push(make_icosphere(2));
    const Ray ray{vec3(0, 0, 5), 0, vec3(0, 0, -1), 10};
    EXPECT_NEAR(accel->closest_hits(std::span(&ray, 1)).front().t, 4, 0.1);
}

TEST_F(HostValidation, ALeakTestFindsNoFaultInAClosedMeshAndRefusesAnOpenOne) {
    SwTlas accel(context());
    const LeakTest test(accel, make_icosphere(2), Level::watertight, 1);
    LeakCounts counts;
    test.trace(1'000, counts);
    test.trace(500, counts, [](const LeakFault&) { FAIL(); });
    EXPECT_EQ(counts.rays, 1'500u);
    EXPECT_EQ(counts.faults(), 0u);
    EXPECT_NEAR(counts.bound_95(), 3.0 / 1'500, 1e-4);
    SwTlas other(context());
    EXPECT_THROW(LeakTest(other, make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)), Level::watertight, 1), Error);
}

TEST_F(HostValidation, ALeakTestRefusesALevelThatTheAcceleratorWasNotMadeFor) {
    SwTlas accel(context());
    EXPECT_EQ(test::error_of([&] { LeakTest(accel, make_icosphere(1), Level::refined, 1); }),
              "SwTlas: LeakTest: level refined is more than the accelerator was made for, level "
              "watertight; see AccelOptions");
}

}  // namespace
