// Validation as a host uses it, and the reference on a device: the arithmetic that robust levels rest on, and
// ReferenceAccel's own behaviour; tests/accel/accel_contract_test.cpp tests all that it shares with the accelerators.
#include <gtest/gtest.h>

#include <cmath>

#include <twinray/geometry.h>
#include <twinray/scene.h>
#include <twinray/tlas.h>
#include <twinray/validation.h>

#include "engine/core/error.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/caller.h"
#include "tests/support/device.h"
#include "validation/reference/float_probe.h"
#include "validation/reference/reference_accel.h"

namespace twinray {
namespace {

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
    EXPECT_EQ(name_of(reference.classify(ray, miss(), TracedBy::software)), "SW_LEAK");
    EXPECT_EQ(reference.classify(ray, miss(), TracedBy::hardware), HitClass::hw_leak);
    EXPECT_EQ(reference.classify_any(ray, false, TracedBy::software), HitClass::sw_leak);
    EXPECT_EQ(reference.classify_any(ray, true, TracedBy::hardware), HitClass::agree);
    EXPECT_THROW(reference.classify(std::span(&ray, 1), {}, TracedBy::software), Error);
    EXPECT_EQ(HitClassCounts().bound_95(), 1);
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

using FloatProbe = test::VulkanTest;

TEST_F(FloatProbe, FindsArithmeticThatTheRobustLevelsCanRestOn) {
    const FloatFacts& properties = probe_floats(context());
    EXPECT_TRUE(robust_faults(properties).empty());
    EXPECT_GT(properties.product_ulp, 0.49) << "some product is rounded at all";
    EXPECT_LE(properties.product_ulp, 0.5);
    EXPECT_LE(properties.sum_ulp, 0.5);
    EXPECT_EQ(properties.has_float64, context().properties().shader_float64);
    EXPECT_TRUE(properties.fuses_fma || !context().state().tuning().has_fused_fma);
    EXPECT_EQ(&probe_floats(context()), &properties) << "once for each driver";
    RecordProperty("quotient_ulp", std::to_string(properties.quotient_ulp));
}

FloatFacts good() {
    FloatFacts properties;
    properties.product_ulp = properties.sum_ulp = properties.quotient_ulp = 0.5;
    properties.error_free_products = properties.compares_nan = true;
    return properties;
}

TEST(RobustFaults, NamesEachThingThatBreaksTheClaim) {
    EXPECT_TRUE(robust_faults(good()).empty());
    FloatFacts properties = good();
    properties.contracts_precise = true;
    properties.product_ulp = 1.5;
    EXPECT_EQ(robust_faults(properties),
              (std::vector<std::string>{"products are wrong by up to 1.5 ulp", "precise products are contracted"}));
    properties = good();
    properties.quotient_ulp = 3;
    properties.sum_ulp = 0.75;
    properties.compares_nan = properties.error_free_products = false;
    EXPECT_EQ(robust_faults(properties).size(), 4u);
}

class ReferenceAccelTest : public test::VulkanTest {};

const Ray ray_down{vec3(0.5f, 0.25f, 10), 0, vec3(0, 0, -1), INFINITY};
Mesh square() { return make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)); }

TEST_F(ReferenceAccelTest, WantsTheSyncSubmittedBeforeATraceIsRecorded) {
    ReferenceAccel accel(context());
    accel.push(square());
    const Buffer rays = device_copy(std::span(&ray_down, 1)), hits(context(), {.name = "hits", .bytes = sizeof(Hit)});
    const TraceDesc desc{.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(), .count = 1};
    test::Caller caller(context());
    const CallerCommands frame = caller.begin();
    {
        Commands commands(context(), "frame", frame);
        accel.sync(commands);
        test::expect_error("not submitted yet", [&] { accel.trace(commands, accel.view(), desc); });
    }
    caller.submit(frame);
    Commands commands(context(), "trace");
    accel.trace(commands, accel.view(), desc);
    commands.submit();
    EXPECT_EQ(download<Hit>(context(), hits, 1).front().t, 10.0f);
}

TEST_F(ReferenceAccelTest, AnswersInFloat64RoundedOnce) {
    const std::unique_ptr<AbstractAccel> accel = make_reference_accel(context());
    const Mesh sphere = make_icosphere(3);
    accel->push(sphere);
    const MeshView view(sphere);
    const ReferenceInstance whole;
    const ReferenceScene reference(std::span(&view, 1), std::span(&whole, 1));
    for (int i = 0; i < 20; ++i) {
        const Ray ray{vec3(0.01f * static_cast<float>(i), 0.3f, 5), 0, vec3(0.01f, 0, -1), INFINITY};
        const ReferenceHit expected = reference.closest_hit(ray);
        const Hit found = accel->closest_hits(std::span(&ray, 1)).front();
        EXPECT_EQ(found.t, static_cast<float>(expected.t));
        EXPECT_EQ(found.primitive_index, expected.primitive);
        EXPECT_EQ(found.u, static_cast<float>(expected.u));
    }
}

TEST_F(ReferenceAccelTest, RefusesWhatNeedsGpuCode) {
    ReferenceAccel accel(context());
    const Bounds box{vec3(0), vec3(1, 2, 3)};
    const AccelHandle handle = accel.push(BoxesView{"box", std::span(&box, 1)});
    accel.sync();
    EXPECT_EQ(accel.world_bound().hi, vec3(1, 2, 3));
    test::expect_error("the scene has boxes", [&] { accel.closest_hits(std::span(&ray_down, 1)); });
    TraceProgramCode code;
    code.name = "spheres";
    test::expect_error("ReferenceAccel: program 'spheres': the host runs no GPU code",
                       [&] { static_cast<void>(accel.make_program(code)); });
    accel.update(handle, square());
    EXPECT_EQ(accel.closest_hits(std::span(&ray_down, 1)).front().t, 10.0f);
    accel.push(square(), Transform{}, {.non_opaque = true});
    test::expect_error("non-opaque instances", [&] { accel.any_hits(std::span(&ray_down, 1)); });
    for (const Feature feature : {Feature::boxes, Feature::filters, Feature::kernel_queries, Feature::save_and_load}) {
        EXPECT_EQ(accel.capability(feature).support, Support::unsupported);
        EXPECT_FALSE(accel.capability(feature).note.empty());
    }
}

TEST(ReportedT, LiesInsideTheOpenIntervalOrIsNone) {
    const auto between = [](double t, float t_min, float t_max) {
        return reported_t(t, {vec3(0), t_min, vec3(0, 0, 1), t_max});
    };
    EXPECT_EQ(between(0.1, 0, INFINITY), 0.1f);
    EXPECT_EQ(between(2 - 1e-12, 0, 2), std::nextafter(2.0f, 0.0f)) << "not rounded to the end";
    EXPECT_EQ(between(2 + 1e-12, 2, 4), std::nextafter(2.0f, 3.0f));
    EXPECT_EQ(between(1e-300, -1, 4), std::nextafter(0.0f, 1.0f));
    EXPECT_EQ(between(1e39, 0, INFINITY), std::nullopt) << "beyond float32";
    EXPECT_EQ(between(2 + 1e-12, 2, std::nextafter(2.0f, 3.0f)), std::nullopt) << "no float between the ends";
}

}  // namespace
}  // namespace twinray
