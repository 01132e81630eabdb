// SPDX-License-Identifier: MIT
// Drivers that are known by name: the row of KernelTuning that each gets, and the layers that labels crash.
#include "engine/core/kernel_tuning.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include <twinray/context.h>
#include "engine/core/vulkan.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

DeviceProperties device_of(VkDriverId driver, DeviceKind kind) {
    DeviceProperties device;
    device.kind = kind;
    device.driver_id = driver;
    device.cpu_threads = kind == DeviceKind::cpu ? 3 : 0;
    device.subgroup_size = 12;
    device.shared_bytes = 64 << 10;
    return device;
}

TEST(KernelTuning, AnyDeviceIsAGpuUntilItsDriverIsKnown) {
    EXPECT_EQ(tuning_for(DeviceProperties{}).row, TuningRow::gpu);
    EXPECT_EQ(tuning_for(device_of(VK_DRIVER_ID_NVIDIA_PROPRIETARY, DeviceKind::discrete)).row, TuningRow::gpu);
    EXPECT_EQ(tuning_for(device_of(VK_DRIVER_ID_GOOGLE_SWIFTSHADER, DeviceKind::cpu)).row, TuningRow::gpu);
    EXPECT_EQ(tuning_for(device_of(VK_DRIVER_ID_MESA_LLVMPIPE, DeviceKind::cpu)).row, TuningRow::cpu_driver);
}

TEST(KernelTuning, OfAGpuGroupsComeInNoOrder) {
    const KernelTuning tuning = tuning_for(device_of(VK_DRIVER_ID_MESA_RADV, DeviceKind::discrete));
    EXPECT_EQ(tuning.threads, 0u);
    EXPECT_EQ(tuning.vector_lanes, 0u);
    EXPECT_EQ(tuning.rays_per_group, 0u);
    EXPECT_FALSE(tuning.has_stack_in_registers);
    EXPECT_EQ(tuning.sort_threads, 0u);
    EXPECT_EQ(tuning.memory_block_bytes, 0u);
    EXPECT_EQ(tuning.most_submission_seconds, 0.5) << "drivers watch it";
}

TEST(KernelTuning, OfACpuDriverGroupsAreItsVectors) {
    const KernelTuning tuning = tuning_for(device_of(VK_DRIVER_ID_MESA_LLVMPIPE, DeviceKind::cpu));
    EXPECT_EQ(tuning.threads, 3u);
    EXPECT_EQ(tuning.vector_lanes, 8u) << "a power of two";
    EXPECT_EQ(tuning.rays_per_group, 1024u);
    EXPECT_TRUE(tuning.has_stack_in_registers);
    EXPECT_EQ(tuning.sort_threads, 3u);
    EXPECT_EQ(tuning.most_submission_seconds, 0) << "nobody watches it";
}

TEST(KernelTuning, SortsNeedRoomForTheirCounters) {
    DeviceProperties device = device_of(VK_DRIVER_ID_MESA_LLVMPIPE, DeviceKind::cpu);
    device.shared_bytes = 16 << 10;
    EXPECT_EQ(tuning_for(device).sort_threads, 0u);
}

TEST(KernelTuning, AnyDeviceCanHaveEitherRow) {
    const DeviceProperties gpu = device_of(VK_DRIVER_ID_MESA_RADV, DeviceKind::discrete);
    const KernelTuning tuning = tuning_for(gpu, TuningRow::cpu_driver);
    EXPECT_EQ(tuning.row, TuningRow::cpu_driver);
    EXPECT_EQ(tuning.threads, 1u) << "some thread runs the groups";
    EXPECT_EQ(tuning_for(device_of(VK_DRIVER_ID_MESA_LLVMPIPE, DeviceKind::cpu), TuningRow::gpu).threads, 0u);
}

TEST(KernelTuning, WhatADriverDoesIsTheSameInEitherRow) {
    for (const TuningRow row : {TuningRow::gpu, TuningRow::cpu_driver}) {
        EXPECT_TRUE(tuning_for(device_of(VK_DRIVER_ID_MESA_RADV, DeviceKind::discrete), row).has_fused_fma);
        EXPECT_FALSE(tuning_for(device_of(VK_DRIVER_ID_MESA_LLVMPIPE, DeviceKind::cpu), row).has_fused_fma);
        EXPECT_TRUE(tuning_for(device_of(VK_DRIVER_ID_MESA_LLVMPIPE, DeviceKind::cpu), row).builds_in_input_order);
    }
}

TEST(KernelTuning, RowsHaveNames) {
    for (const TuningRow row : {TuningRow::gpu, TuningRow::cpu_driver}) EXPECT_EQ(parse_tuning_row(name_of(row)), row);
    EXPECT_EQ(parse_tuning_row(""), std::nullopt);
    EXPECT_EQ(test::error_of([] { parse_tuning_row("cuda"); }), "kernel tuning 'cuda' is not one of gpu, cpu_driver");
}

VkLayerProperties layer(const char* name, std::uint32_t patch) {
    VkLayerProperties properties{};
    std::strcpy(properties.layerName, name);
    properties.specVersion = VK_MAKE_API_VERSION(0, 1, 3, patch);
    return properties;
}

TEST(DebugLabels, AreLeftOutBesideAValidationLayerThatTheyCrash) {
    const VkLayerProperties old_validation = layer("VK_LAYER_KHRONOS_validation", 242);
    const VkLayerProperties first_mended = layer("VK_LAYER_KHRONOS_validation", 243);
    const VkLayerProperties old_other = layer("VK_LAYER_MESA_overlay", 211);
    EXPECT_TRUE(labels_are_safe({}));
    EXPECT_TRUE(labels_are_safe(std::array{old_other, first_mended}));
    EXPECT_FALSE(labels_are_safe(std::array{old_other, old_validation}));
}

}  // namespace
}  // namespace twinray
