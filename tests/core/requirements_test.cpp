// Requirements as listed before a device is created, the choice of a device, and what its info says; drivers that are
// known by name: the row of KernelTuning that each gets, and the layers that labels crash.
#include <gtest/gtest.h>

#include <twinray/context.h>
#include "engine/core/device_properties.h"
#include "engine/core/kernel_tuning.h"
#include "engine/core/requirement.h"
#include "engine/core/vulkan.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

DeviceProperties capable() {
    DeviceProperties properties;
    properties.api_version = VK_API_VERSION_1_2;
    properties.has_compute_queue = true;
    properties.group_invocations = KernelLimits::group_invocations;
    for (const FeatureBit& bit : feature_bits()) properties.*bit.fact = true;
    return properties;
}

struct Info : VkDeviceCreateInfo {
    Info() : VkDeviceCreateInfo{} { sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO; }

    // Returns how often each type of struct is in the chain.
    std::map<VkStructureType, int> types() const {
        std::map<VkStructureType, int> counts;
        for (auto* node = static_cast<const VkBaseInStructure*>(pNext); node; node = node->pNext) ++counts[node->sType];
        return counts;
    }
    int count_of(const char* extension) const {
        int count = 0;
        for (std::uint32_t i = 0; i < enabledExtensionCount; ++i)
            count += std::strcmp(ppEnabledExtensionNames[i], extension) == 0;
        return count;
    }
};

void expect_all_on(const Info& info) {
    DeviceProperties properties = capable();
    for (const FeatureBit& bit : feature_bits()) properties.*bit.fact = false;
    state_features(info, properties);
    for (const FeatureBit& bit : feature_bits()) EXPECT_TRUE(properties.*bit.fact) << bit.name;
    for (const auto& [type, count] : info.types()) EXPECT_EQ(count, 1) << type;
    EXPECT_EQ(info.count_of(VK_KHR_RAY_QUERY_EXTENSION_NAME), 1);
}

TEST(Requirements, AreToldInSentences) {
    DeviceProperties properties = capable();
    for (const Requirement& met : requirements_of(properties))
        test::expect_contains(met.sentence(), "; this device has it");
    properties.scalar_block_layout = properties.acceleration_structure = false;
    std::vector<std::string> lacking;
    for (const Requirement& requirement : requirements_of(properties))
        if (!requirement.is_met) lacking.push_back(requirement.sentence());
    ASSERT_EQ(lacking.size(), 2u);
    EXPECT_EQ(
        lacking[0],
        "twinray needs scalarBlockLayout because structs have the same bytes on the host and on the GPU; this device "
        "lacks it");
    EXPECT_EQ(lacking[1],
              "HwTlas needs VK_KHR_acceleration_structure because the driver builds its structures; this device lacks "
              "it, SwTlas works without");
}

TEST(Requirements, AreLimitsToo) {
    DeviceProperties properties = capable();
    EXPECT_TRUE(missing_for_software(properties).empty());
    properties.group_invocations = 128;
    properties.shared_bytes = 8192;
    properties.push_constant_bytes = 64;
    const std::vector<std::string> missing = missing_for_software(properties);
    ASSERT_EQ(missing.size(), 3u);
    EXPECT_EQ(missing[0], "groups of 256 invocations (maxComputeWorkGroupInvocations, maxComputeWorkGroupSize)");
    EXPECT_EQ(missing[1], "16384 bytes of shared memory (maxComputeSharedMemorySize)");
    EXPECT_EQ(missing[2], "128 bytes of push constants (maxPushConstantsSize)");
}

// A feature that a GPU of 2018 may lack is required only by the part that needs it.
TEST(Requirements, AreOfTheirPartAlone) {
    DeviceProperties properties = capable();
    properties.shader_float64 = properties.shader_int64 = properties.acceleration_structure = properties.ray_query =
        false;
    properties.ray_tracing_pipeline = properties.primitive_culling = properties.runtime_descriptor_array = false;
    properties.subgroup_size = 1;
    properties.shared_bytes = KernelLimits::shared_bytes;
    EXPECT_TRUE(missing_for_software(properties).empty());
    std::vector<Requirement::Of> lacking;
    for (const Requirement& requirement : requirements_of(properties))
        if (!requirement.is_met) lacking.push_back(requirement.of);
    using enum Requirement::Of;
    EXPECT_EQ(lacking, (std::vector{hardware, hardware, ray_queries, ray_pipelines, refinement, points, contacts,
                                    int64_kernels, primitive_culling, images}));
}

TEST(Requirements, TexturesAreImagesWhereNothingOfDescriptorIndexingLacks) {
    EXPECT_TRUE(capable().has_image_arrays());
    for (bool DeviceProperties::*fact :
         {&DeviceProperties::runtime_descriptor_array, &DeviceProperties::variable_descriptor_count,
          &DeviceProperties::nonuniform_sampled_images, &DeviceProperties::update_after_bind_images}) {
        DeviceProperties properties = capable();
        properties.*fact = false;
        EXPECT_FALSE(properties.has_image_arrays());
        EXPECT_TRUE(missing_for_software(properties).empty() && missing_for_hardware(properties).empty());
        test::expect_contains(requirements_of(properties).back().sentence(),
                              "this device lacks it, textures in buffers work without");
    }
}

TEST(Requirements, OfADeviceWithNothingElse) {
    const DeviceRequirements requirements(capable());
    Info info;
    info.pNext = requirements.features();
    info.enabledExtensionCount = static_cast<std::uint32_t>(requirements.extensions().size());
    info.ppEnabledExtensionNames = requirements.extensions().data();
    expect_all_on(info);
}

TEST(Requirements, JoinAnEmptyInfo) {
    DeviceRequirements requirements(capable());
    Info info;
    requirements.add_to(info);
    expect_all_on(info);
}

TEST(Requirements, GoIntoTheHostsStructs) {
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{};
    structure.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    VkPhysicalDeviceVulkan12Features vulkan12{};
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.pNext = &structure;
    vulkan12.descriptorIndexing = VK_TRUE;
    VkPhysicalDeviceFeatures2 core{};
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    core.pNext = &vulkan12;
    core.features.geometryShader = VK_TRUE;
    const char* names[] = {VK_KHR_RAY_QUERY_EXTENSION_NAME, "VK_KHR_swapchain"};
    Info info;
    info.pNext = &core;
    info.enabledExtensionCount = 2;
    info.ppEnabledExtensionNames = names;
    DeviceRequirements requirements(capable());
    requirements.add_to(info);
    expect_all_on(info);
    EXPECT_TRUE(vulkan12.timelineSemaphore && vulkan12.bufferDeviceAddress && vulkan12.scalarBlockLayout);
    EXPECT_TRUE(structure.accelerationStructure && core.features.shaderInt64);
    EXPECT_TRUE(vulkan12.descriptorIndexing && core.features.geometryShader) << "the host's own";
    EXPECT_EQ(info.count_of("VK_KHR_swapchain"), 1);
    EXPECT_EQ(info.types().count(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES), 0u);
}

// Vulkan forbids these structs beside that of version 1.2, so the others must come as structs of one feature.
TEST(Requirements, StandBesideStructsOfSingleFeatures) {
    VkPhysicalDeviceTimelineSemaphoreFeatures timeline{};
    timeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
    Info info;
    info.pNext = &timeline;
    DeviceRequirements requirements(capable());
    requirements.add_to(info);
    expect_all_on(info);
    EXPECT_TRUE(timeline.timelineSemaphore);
    EXPECT_EQ(info.types().count(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES), 0u);
}

TEST(Requirements, TakeOverFeaturesInTheOldPlace) {
    VkPhysicalDeviceFeatures features{};
    features.wideLines = VK_TRUE;
    Info info;
    info.pEnabledFeatures = &features;
    DeviceRequirements requirements(capable());
    requirements.add_to(info);
    expect_all_on(info);
    EXPECT_EQ(info.pEnabledFeatures, nullptr) << "forbidden beside VkPhysicalDeviceFeatures2";
    FeatureBit wide_lines = feature_bits().front();
    wide_lines.own_offset = offsetof(VkPhysicalDeviceFeatures2, features.wideLines);
    EXPECT_TRUE(*find_bit(static_cast<VkBaseOutStructure*>(const_cast<void*>(info.pNext)), wide_lines));
}

TEST(Requirements, LeaveOutWhatTheDeviceLacks) {
    DeviceProperties properties = capable();
    properties.ray_tracing_pipeline = false;
    DeviceRequirements requirements(properties);
    Info info;
    requirements.add_to(info);
    EXPECT_EQ(info.count_of(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME), 0);
    EXPECT_EQ(info.types().count(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR), 0u);
}

TEST(EnabledFeatures, AFeatureWithoutItsExtensionIsNotEnabled) {
    const DeviceRequirements requirements(capable());
    Info info;
    info.pNext = requirements.features();
    DeviceProperties properties = capable();
    state_features(info, properties);
    EXPECT_FALSE(properties.acceleration_structure || properties.ray_query || properties.ray_tracing_pipeline);
    EXPECT_TRUE(properties.timeline_semaphore);
}

TEST(EnabledFeatures, TheOldPlaceCounts) {
    VkPhysicalDeviceFeatures features{};
    features.shaderInt64 = VK_TRUE;
    Info info;
    info.pEnabledFeatures = &features;
    DeviceProperties properties;
    state_features(info, properties);
    EXPECT_TRUE(properties.shader_int64);
    EXPECT_FALSE(properties.timeline_semaphore);
}

TEST(EnabledFeatures, ThatTheDeviceLacksAreNamed) {
    DeviceProperties supported = capable();
    EXPECT_EQ(feature_beyond(capable(), supported), nullptr);
    supported.ray_query = false;
    EXPECT_STREQ(feature_beyond(capable(), supported), "rayQuery");
    EXPECT_EQ(feature_beyond(supported, capable()), nullptr);
}

DeviceProperties capable(const char* name, DeviceKind kind) {
    DeviceProperties device = capable();
    device.name = name;
    device.kind = kind;
    device.ray_tracing_pipeline = false;
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
    old.api_version = VK_API_VERSION_1_1;
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
