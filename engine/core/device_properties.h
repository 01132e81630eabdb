// SPDX-License-Identifier: MIT
// What a Vulkan device can do, asked of its driver, and what to switch on when one is created.
#pragma once

#include <vector>

#include "engine/core/feature_chain.h"

namespace twinray {

// Asks the driver. Functions of the instance level must be loaded.
DeviceProperties query_device_properties(const VulkanTable& vk, VkPhysicalDevice device);
std::vector<VkPhysicalDevice> physical_devices(const VulkanTable& vk, VkInstance instance);
std::vector<VkExtensionProperties> device_extensions(const VulkanTable& vk, VkPhysicalDevice device);

// First queue family with compute; -1 if none.
int compute_queue_family(const VulkanTable& vk, VkPhysicalDevice device);

}  // namespace twinray
