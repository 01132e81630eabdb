// SPDX-License-Identifier: MIT
// The driver's report on a device that it lost (VK_EXT_device_fault).
#pragma once

#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace twinray {

struct VulkanTable;

struct DeviceFault {
    std::string description = {};
    std::vector<VkDeviceFaultAddressInfoEXT> addresses = {};
    std::vector<VkDeviceFaultVendorInfoEXT> vendor = {};
};

// Queries a lost device; returns an empty fault if the driver does not tell.
DeviceFault query_device_fault(const VulkanTable& vk, VkDevice device);

// Formats it: "; the driver says: 'ring hang', invalid read at 0x1200 to 0x12ff, 'engine' (code 0x7, data 0x1)"; empty
// if there is nothing.
std::string sentence(const DeviceFault& fault);

}  // namespace twinray
