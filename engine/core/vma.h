// SPDX-License-Identifier: MIT
// The allocator's life; vma.cpp is the one file that compiles the Vulkan Memory Allocator.
#pragma once

#include "engine/core/vulkan_functions.h"

typedef struct VmaAllocator_T* VmaAllocator;

namespace twinray {

VmaAllocator create_allocator(const VulkanFunctions& vk, VkInstance instance, VkPhysicalDevice physical_device,
                              VkDevice device, std::uint32_t api_version);
void destroy_allocator(VmaAllocator allocator);

// Bytes in live allocations.
std::uint64_t allocated_bytes(VmaAllocator allocator);

}  // namespace twinray
