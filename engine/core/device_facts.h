// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "engine/core/device_choice.h"
#include "engine/core/vulkan_functions.h"

namespace twinray {

// Asks the driver. Functions of the instance level must be loaded.
DeviceFacts query_device_facts(const VulkanFunctions& vk, VkPhysicalDevice device);
std::vector<VkPhysicalDevice> physical_devices(const VulkanFunctions& vk, VkInstance instance);

// First queue family with compute; -1 if none.
int compute_queue_family(const VulkanFunctions& vk, VkPhysicalDevice device);

// The extensions and the feature chain that twinray enables on a device with these facts. Not copyable: the chain
// points into itself. features() goes to VkDeviceCreateInfo::pNext.
class DeviceRequirements {
  public:
    explicit DeviceRequirements(const DeviceFacts& facts);
    DeviceRequirements(const DeviceRequirements&) = delete;
    DeviceRequirements& operator=(const DeviceRequirements&) = delete;

    const std::vector<const char*>& extensions() const { return extensions_; }
    const VkPhysicalDeviceFeatures2* features() const { return &features_; }

  private:
    std::vector<const char*> extensions_;
    VkPhysicalDeviceFeatures2 features_{};
    VkPhysicalDeviceVulkan12Features vulkan12_{};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration_structure_{};
    VkPhysicalDeviceRayQueryFeaturesKHR ray_query_{};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR ray_tracing_pipeline_{};
};

}  // namespace twinray
