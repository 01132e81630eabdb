// SPDX-License-Identifier: MIT
// twinray's own allocator; only vma.cpp compiles the Vulkan Memory Allocator.
#pragma once

#include "engine/core/allocator.h"

namespace twinray {

// `block_bytes`: KernelTuning::memory_block_bytes.
VmaAllocator create_vma(const VulkanTable& vk, VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
                        std::uint32_t api_version, std::uint64_t block_bytes);
void destroy_vma(VmaAllocator allocator);
AllocatorHooks vma_hooks(VmaAllocator allocator);

}  // namespace twinray
