// SPDX-License-Identifier: MIT
// Features that accelerators have on a device, and which accelerator is chosen for it.
#include <twinray/tlas.h>
#include <twinray/trace.h>

#include <gtest/gtest.h>

#include <set>

#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

TEST(Capability, EveryFeatureHasANameOfItsOwn) {
    std::set<std::string> names;
    for (std::size_t i = 0; i < feature_count; ++i) names.insert(name_of(static_cast<Feature>(i)));
    EXPECT_EQ(names.size(), feature_count);
}

TEST(Capability, LevelsHaveTheirFeatures) {
    EXPECT_EQ(feature_of(Level::fast), Feature::level_fast);
    EXPECT_EQ(feature_of(Level::certified), Feature::level_certified);
}

TEST(Capability, QueriesInKernelsNeedRayQueriesOnHardwareAlone) {
    DeviceProperties device;
    EXPECT_EQ(HwTlas::capability_on(device, Feature::kernel_queries).support, Support::unsupported);
    EXPECT_EQ(SwTlas::capability_on(device, Feature::kernel_queries).support, Support::native);
    device.ray_query = true;
    EXPECT_EQ(HwTlas::capability_on(device, Feature::kernel_queries).support, Support::native);
}

TEST(Capability, WhatIsUnsupportedSaysWhy) {
    for (std::size_t i = 0; i < feature_count; ++i)
        for (const Capability& capability :
             {HwTlas::capability_on({}, static_cast<Feature>(i)), SwTlas::capability_on({}, static_cast<Feature>(i))})
            EXPECT_TRUE(capability.support != Support::unsupported || !capability.note.empty())
                << name_of(capability.feature);
}

DeviceProperties device_of(DeviceKind kind) {
    DeviceProperties device;
    device.name = "GPU 9";
    device.kind = kind;
    device.api_version = (1u << 22) | (2u << 12);  // Vulkan 1.2
    device.has_compute_queue = device.timeline_semaphore = device.buffer_device_address = true;
    device.scalar_block_layout = device.shader_int64 = true;
    device.group_invocations = 1024;
    device.acceleration_structure = device.ray_query = device.ray_tracing_pipeline = true;
    return device;
}

std::string refusal_of(const DeviceProperties& device, const std::string& request, const AccelNeeds& needs = {}) {
    return test::error_of([&] { choose_accel(device, request, needs); });
}

TEST(AccelChoice, AutomaticIsHardwareWhereTheDeviceHasIt) {
    for (const DeviceKind kind :
         {DeviceKind::discrete, DeviceKind::integrated, DeviceKind::virtual_gpu, DeviceKind::other})
        EXPECT_EQ(choose_accel(device_of(kind), "auto"), (AccelChoice{false, "device 'GPU 9' has VK_KHR_ray_query"}));
    DeviceProperties pipelines = device_of(DeviceKind::discrete);
    pipelines.ray_query = false;
    EXPECT_EQ(choose_accel(pipelines, "auto"), (AccelChoice{false, "device 'GPU 9' has VK_KHR_ray_tracing_pipeline"}));
}

TEST(AccelChoice, AutomaticIsSoftwareOnACpu) {
    EXPECT_EQ(choose_accel(device_of(DeviceKind::cpu), "auto"),
              (AccelChoice{true, "device 'GPU 9' is a CPU, without hardware for rays"}));
    EXPECT_FALSE(choose_accel(device_of(DeviceKind::cpu), "hw").is_software) << "it works where it is asked for";
}

TEST(AccelChoice, WhatHardwareLacksIsNamed) {
    DeviceProperties none = device_of(DeviceKind::discrete);
    none.acceleration_structure = none.ray_query = none.ray_tracing_pipeline = false;
    EXPECT_EQ(choose_accel(none, "auto"),
              (AccelChoice{true,
                           "device 'GPU 9' lacks VK_KHR_acceleration_structure, VK_KHR_ray_query or "
                           "VK_KHR_ray_tracing_pipeline"}));
    EXPECT_EQ(refusal_of(none, "hw"),
              "--accel hw: device 'GPU 9' lacks VK_KHR_acceleration_structure, VK_KHR_ray_query or "
              "VK_KHR_ray_tracing_pipeline; --accel sw works there");
    EXPECT_EQ(choose_accel(none, "sw"), (AccelChoice{true, "asked for"}));
}

TEST(AccelChoice, NeedsThatHardwareDoesNotMeetChooseSoftware) {
    DeviceProperties device = device_of(DeviceKind::discrete);
    const AccelNeeds certified{.level = Level::certified}, kernels{.kernel_queries = true};
    EXPECT_FALSE(choose_accel(device, "auto", {.level = Level::refined}).is_software);
    EXPECT_FALSE(choose_accel(device, "auto", kernels).is_software);
    EXPECT_TRUE(choose_accel(device, "auto", certified).is_software);
    EXPECT_NE(refusal_of(device, "hw", certified).find("level certified is of software alone"), std::string::npos);
    device.ray_query = false;
    EXPECT_TRUE(choose_accel(device, "auto", kernels).is_software);
    EXPECT_NE(refusal_of(device, "hw", kernels).find("lacks VK_KHR_ray_query"), std::string::npos);
    EXPECT_FALSE(choose_accel(device, "hw").is_software);
}

TEST(AccelChoice, NothingElseIsTaken) {
    EXPECT_EQ(refusal_of(device_of(DeviceKind::cpu), "gpu"), "accelerator 'gpu' is not auto, sw or hw");
}

}  // namespace
}  // namespace twinray
