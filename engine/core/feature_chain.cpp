// SPDX-License-Identifier: MIT
#include "engine/core/feature_chain.h"

#include <cstring>

namespace twinray {
namespace {

constexpr VkStructureType type_of_core = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
constexpr VkStructureType type_of_vulkan12 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
constexpr VkStructureType type_of_timeline = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
constexpr VkStructureType type_of_address = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES;
constexpr VkStructureType type_of_layout = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES;
constexpr VkStructureType type_of_indexing = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES;
constexpr VkStructureType type_of_structure = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
constexpr VkStructureType type_of_query = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
constexpr VkStructureType type_of_tracing = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR;
constexpr VkStructureType type_of_fault = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FAULT_FEATURES_EXT;

constexpr FeatureBit alone(bool DeviceProperties::*fact, const char* name, VkStructureType type, std::size_t offset) {
    return {fact, name, type, offset, type, offset};
}

constexpr FeatureBit bits[] = {
    alone(&DeviceProperties::shader_int64, "shaderInt64", type_of_core,
          offsetof(VkPhysicalDeviceFeatures2, features.shaderInt64)),
    alone(&DeviceProperties::shader_float64, "shaderFloat64", type_of_core,
          offsetof(VkPhysicalDeviceFeatures2, features.shaderFloat64)),
    {&DeviceProperties::timeline_semaphore, "timelineSemaphore", type_of_timeline,
     offsetof(VkPhysicalDeviceTimelineSemaphoreFeatures, timelineSemaphore), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, timelineSemaphore)},
    {&DeviceProperties::buffer_device_address, "bufferDeviceAddress", type_of_address,
     offsetof(VkPhysicalDeviceBufferDeviceAddressFeatures, bufferDeviceAddress), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, bufferDeviceAddress)},
    {&DeviceProperties::scalar_block_layout, "scalarBlockLayout", type_of_layout,
     offsetof(VkPhysicalDeviceScalarBlockLayoutFeatures, scalarBlockLayout), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, scalarBlockLayout)},
    {&DeviceProperties::runtime_descriptor_array, "runtimeDescriptorArray", type_of_indexing,
     offsetof(VkPhysicalDeviceDescriptorIndexingFeatures, runtimeDescriptorArray), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, runtimeDescriptorArray)},
    {&DeviceProperties::variable_descriptor_count, "descriptorBindingVariableDescriptorCount", type_of_indexing,
     offsetof(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingVariableDescriptorCount), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, descriptorBindingVariableDescriptorCount)},
    {&DeviceProperties::nonuniform_sampled_images, "shaderSampledImageArrayNonUniformIndexing", type_of_indexing,
     offsetof(VkPhysicalDeviceDescriptorIndexingFeatures, shaderSampledImageArrayNonUniformIndexing), type_of_vulkan12,
     offsetof(VkPhysicalDeviceVulkan12Features, shaderSampledImageArrayNonUniformIndexing)},
    {&DeviceProperties::update_after_bind_images, "descriptorBindingSampledImageUpdateAfterBind", type_of_indexing,
     offsetof(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingSampledImageUpdateAfterBind),
     type_of_vulkan12, offsetof(VkPhysicalDeviceVulkan12Features, descriptorBindingSampledImageUpdateAfterBind)},
    alone(&DeviceProperties::acceleration_structure, "accelerationStructure", type_of_structure,
          offsetof(VkPhysicalDeviceAccelerationStructureFeaturesKHR, accelerationStructure)),
    alone(&DeviceProperties::ray_query, "rayQuery", type_of_query,
          offsetof(VkPhysicalDeviceRayQueryFeaturesKHR, rayQuery)),
    alone(&DeviceProperties::ray_tracing_pipeline, "rayTracingPipeline", type_of_tracing,
          offsetof(VkPhysicalDeviceRayTracingPipelineFeaturesKHR, rayTracingPipeline)),
    alone(&DeviceProperties::primitive_culling, "rayTraversalPrimitiveCulling", type_of_tracing,
          offsetof(VkPhysicalDeviceRayTracingPipelineFeaturesKHR, rayTraversalPrimitiveCulling)),
    alone(&DeviceProperties::device_fault, "deviceFault", type_of_fault,
          offsetof(VkPhysicalDeviceFaultFeaturesEXT, deviceFault)),
};

VkBool32* bit_at(VkBaseOutStructure* node, std::size_t offset) {
    return reinterpret_cast<VkBool32*>(reinterpret_cast<std::byte*>(node) + offset);
}

bool has_extension(const VkDeviceCreateInfo& info, const char* name) {
    for (const char* extension : std::span(info.ppEnabledExtensionNames, info.enabledExtensionCount))
        if (std::strcmp(extension, name) == 0) return true;
    return false;
}

}  // namespace

FeatureStructs::FeatureStructs() {
    core.sType = type_of_core;
    timeline.sType = type_of_timeline;
    address.sType = type_of_address;
    layout.sType = type_of_layout;
    indexing.sType = type_of_indexing;
    structure.sType = type_of_structure;
    query.sType = type_of_query;
    pipeline.sType = type_of_tracing;
    fault.sType = type_of_fault;
}

VkBaseOutStructure* FeatureStructs::find(VkStructureType type) {
    void* all[] = {&core, &timeline, &address, &layout, &indexing, &structure, &query, &pipeline, &fault};
    for (void* node : all)
        if (auto* base = static_cast<VkBaseOutStructure*>(node); base->sType == type) return base;
    return nullptr;
}

std::span<const FeatureBit> feature_bits() { return bits; }

VkBool32* find_bit(VkBaseOutStructure* chain, const FeatureBit& bit) {
    for (; chain; chain = chain->pNext) {
        if (chain->sType == bit.own) return bit_at(chain, bit.own_offset);
        if (chain->sType == bit.gathered) return bit_at(chain, bit.gathered_offset);
    }
    return nullptr;
}

VkBool32& provide_bit(VkDeviceCreateInfo& info, FeatureStructs& ours, const FeatureBit& bit) {
    auto* chain = static_cast<VkBaseOutStructure*>(const_cast<void*>(info.pNext));
    if (VkBool32* found = find_bit(chain, bit)) return *found;
    VkBaseOutStructure* added = ours.find(bit.own);
    if (bit.own == type_of_core && info.pEnabledFeatures) {
        // Vulkan forbids the one beside the other.
        ours.core.features = *info.pEnabledFeatures;
        info.pEnabledFeatures = nullptr;
    }
    added->pNext = chain;
    info.pNext = added;
    return *find_bit(added, bit);
}

void state_features(const VkDeviceCreateInfo& info, DeviceProperties& properties) {
    auto* chain = static_cast<VkBaseOutStructure*>(const_cast<void*>(info.pNext));
    VkPhysicalDeviceFeatures2 old_style{};
    old_style.sType = type_of_core;
    if (info.pEnabledFeatures) old_style.features = *info.pEnabledFeatures;
    for (const FeatureBit& bit : bits) {
        const VkBool32* found = find_bit(chain, bit);
        if (!found && bit.own == type_of_core)
            found = bit_at(reinterpret_cast<VkBaseOutStructure*>(&old_style), bit.own_offset);
        properties.*bit.fact = found && *found;
    }
    properties.acceleration_structure &= has_extension(info, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME) &&
                                         has_extension(info, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME);
    properties.ray_query &= properties.acceleration_structure && has_extension(info, VK_KHR_RAY_QUERY_EXTENSION_NAME);
    properties.ray_tracing_pipeline &=
        properties.acceleration_structure && has_extension(info, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
    properties.primitive_culling &= properties.ray_tracing_pipeline;
    properties.device_fault &= has_extension(info, VK_EXT_DEVICE_FAULT_EXTENSION_NAME);
    properties.external_memory_fd = has_extension(info, VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
}

const char* feature_beyond(const DeviceProperties& told, const DeviceProperties& supported) {
    for (const FeatureBit& bit : bits)
        if (told.*bit.fact && !(supported.*bit.fact)) return bit.name;
    return nullptr;
}

}  // namespace twinray
