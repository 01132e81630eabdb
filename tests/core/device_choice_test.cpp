// SPDX-License-Identifier: MIT
#include <twinray/context.h>

#include <gtest/gtest.h>

namespace twinray {
namespace {

DeviceProperties capable(const char* name, DeviceKind kind) {
    DeviceProperties device;
    device.name = name;
    device.kind = kind;
    device.api_version = (1u << 22) | (3u << 12);
    device.has_compute_queue = device.timeline_semaphore = device.buffer_device_address = true;
    device.scalar_block_layout = device.shader_int64 = true;
    device.group_invocations = 1024;
    device.acceleration_structure = device.ray_query = true;
    return device;
}

TEST(DeviceChoice, PrefersRayTracingThenDiscrete) {
    DeviceProperties plain = capable("plain discrete", DeviceKind::discrete);
    plain.acceleration_structure = false;
    const std::vector<DeviceProperties> devices = {capable("cpu", DeviceKind::cpu), plain,
                                                   capable("integrated", DeviceKind::integrated)};
    EXPECT_EQ(choose_device(devices, "").index, 2);
    EXPECT_EQ(choose_device(std::span(devices).first(2), "").index, 0);
}

TEST(DeviceChoice, TakesAnIndexOrAPartOfTheName) {
    const std::vector<DeviceProperties> devices = {capable("Alpha One", DeviceKind::discrete),
                                                   capable("Beta Two", DeviceKind::cpu)};
    EXPECT_EQ(choose_device(devices, "1").index, 1);
    EXPECT_EQ(choose_device(devices, "two").index, 1);
    EXPECT_EQ(choose_device(devices, "gamma").index, -1);
    EXPECT_EQ(choose_device(devices, "7").index, -1);
}

TEST(DeviceChoice, SaysWhyEachOtherDeviceWasRejected) {
    DeviceProperties old = capable("old", DeviceKind::discrete);
    old.api_version = (1u << 22) | (1u << 12);
    old.scalar_block_layout = false;
    const std::vector<DeviceProperties> devices = {old, capable("good", DeviceKind::cpu),
                                                   capable("also good", DeviceKind::cpu)};
    const DeviceChoice choice = choose_device(devices, "");
    ASSERT_EQ(choice.index, 1);
    ASSERT_EQ(choice.rejections.size(), 2u);
    EXPECT_EQ(choice.rejections[0], "0 'old': lacks Vulkan 1.2, scalarBlockLayout");
    EXPECT_EQ(choice.rejections[1], "2 'also good': ranks behind 'good'");
}

TEST(DeviceChoice, OfNothingIsNothing) {
    EXPECT_EQ(choose_device({}, "").index, -1);
    EXPECT_TRUE(choose_device({}, "").rejections.empty());
}

TEST(DeviceChoice, APipelineAloneIsEnoughForHardware) {
    DeviceProperties device = capable("data centre", DeviceKind::discrete);
    device.ray_query = false;
    EXPECT_FALSE(missing_for_hardware(device).empty());
    device.ray_tracing_pipeline = true;
    EXPECT_TRUE(missing_for_hardware(device).empty());
    EXPECT_TRUE(missing_for_software(device).empty());
}

}  // namespace
}  // namespace twinray
