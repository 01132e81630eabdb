// SPDX-License-Identifier: MIT
#include "engine/core/device_facts.h"

#include <cstring>

namespace twinray {
namespace {

DeviceKind kind_of(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return DeviceKind::discrete;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return DeviceKind::integrated;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return DeviceKind::virtual_gpu;
        case VK_PHYSICAL_DEVICE_TYPE_CPU: return DeviceKind::cpu;
        default: return DeviceKind::other;
    }
}

bool has_extension(const std::vector<VkExtensionProperties>& extensions, const char* name) {
    for (const VkExtensionProperties& extension : extensions)
        if (std::strcmp(extension.extensionName, name) == 0) return true;
    return false;
}

std::vector<VkExtensionProperties> device_extensions(const VulkanFunctions& vk, VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vk_check(vk.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "list device extensions");
    std::vector<VkExtensionProperties> extensions(count);
    vk_check(vk.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()),
             "list device extensions");
    return extensions;
}

void query_features(const VulkanFunctions& vk, VkPhysicalDevice device, DeviceFacts& facts) {
    const std::vector<VkExtensionProperties> extensions = device_extensions(vk, device);
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR, nullptr, {}, {}, {}, {}, {}};
    VkPhysicalDeviceRayQueryFeaturesKHR query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR, &pipeline, {}};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR, &query, {}, {}, {}, {}, {}};
    VkPhysicalDeviceVulkan12Features vulkan12{};
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.pNext = &structure;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &vulkan12;
    vk.vkGetPhysicalDeviceFeatures2(device, &features);

    facts.timeline_semaphore = vulkan12.timelineSemaphore;
    facts.buffer_device_address = vulkan12.bufferDeviceAddress;
    facts.scalar_block_layout = vulkan12.scalarBlockLayout;
    facts.shader_int64 = features.features.shaderInt64;
    facts.shader_float64 = features.features.shaderFloat64;
    facts.acceleration_structure = structure.accelerationStructure &&
                                   has_extension(extensions, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME) &&
                                   has_extension(extensions, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME);
    facts.ray_query =
        facts.acceleration_structure && query.rayQuery && has_extension(extensions, VK_KHR_RAY_QUERY_EXTENSION_NAME);
    facts.ray_tracing_pipeline = facts.acceleration_structure && pipeline.rayTracingPipeline &&
                                 has_extension(extensions, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
}

}  // namespace

std::vector<VkPhysicalDevice> physical_devices(const VulkanFunctions& vk, VkInstance instance) {
    std::uint32_t count = 0;
    vk_check(vk.vkEnumeratePhysicalDevices(instance, &count, nullptr), "list Vulkan devices");
    std::vector<VkPhysicalDevice> devices(count);
    vk_check(vk.vkEnumeratePhysicalDevices(instance, &count, devices.data()), "list Vulkan devices");
    return devices;
}

int compute_queue_family(const VulkanFunctions& vk, VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (std::uint32_t i = 0; i < count; ++i)
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) return static_cast<int>(i);
    return -1;
}

DeviceFacts query_device_facts(const VulkanFunctions& vk, VkPhysicalDevice device) {
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &driver;
    vk.vkGetPhysicalDeviceProperties2(device, &properties);

    DeviceFacts facts;
    facts.name = properties.properties.deviceName;
    facts.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    facts.kind = kind_of(properties.properties.deviceType);
    facts.api_version = properties.properties.apiVersion;
    facts.builds_in_input_order = driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE;
    facts.has_compute_queue = compute_queue_family(vk, device) >= 0;
    if (facts.api_version >= VK_API_VERSION_1_2) query_features(vk, device, facts);
    return facts;
}

DeviceRequirements::DeviceRequirements(const DeviceFacts& facts) {
    features_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features_.features.shaderInt64 = VK_TRUE;
    vulkan12_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12_.timelineSemaphore = VK_TRUE;
    vulkan12_.bufferDeviceAddress = VK_TRUE;
    vulkan12_.scalarBlockLayout = VK_TRUE;
    features_.pNext = &vulkan12_;
    if (!facts.acceleration_structure) return;

    extensions_ = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
    acceleration_structure_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    acceleration_structure_.accelerationStructure = VK_TRUE;
    vulkan12_.pNext = &acceleration_structure_;
    void** next = &acceleration_structure_.pNext;
    if (facts.ray_query) {
        extensions_.push_back(VK_KHR_RAY_QUERY_EXTENSION_NAME);
        ray_query_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
        ray_query_.rayQuery = VK_TRUE;
        *next = &ray_query_;
        next = &ray_query_.pNext;
    }
    if (facts.ray_tracing_pipeline) {
        extensions_.push_back(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
        ray_tracing_pipeline_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR;
        ray_tracing_pipeline_.rayTracingPipeline = VK_TRUE;
        *next = &ray_tracing_pipeline_;
    }
}

}  // namespace twinray
