// SPDX-License-Identifier: MIT
// Whether a driver tells what it made of a pipeline.
#pragma once

#include <vector>

#include <vulkan/vulkan_core.h>

namespace twinray {

struct VulkanTable;

// Lets the driver tell of pipelines (VK_KHR_pipeline_executable_properties).
class StatisticsFeature {
  public:
    // Nothing where the device has no such thing. `info` refers to this object until vkCreateDevice. Once.
    void add_to(VkDeviceCreateInfo& info, const VulkanTable& vk, VkPhysicalDevice device);

  private:
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR feature_{};
    std::vector<const char*> extensions_;
};

}  // namespace twinray
