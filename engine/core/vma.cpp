// SPDX-License-Identifier: MIT
#define VMA_IMPLEMENTATION
#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_VULKAN_VERSION 1003000
#include <vulkan/vulkan_core.h>

#include <vk_mem_alloc.h>

#include "engine/core/vma.h"
#include "engine/core/vulkan.h"
#include <twinray/vma_adapter.h>

namespace twinray {
VmaAllocator create_vma(const VulkanTable& vk, VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
                        std::uint32_t api_version, std::uint64_t block_bytes) {
    VmaVulkanFunctions functions{};
    functions.vkGetInstanceProcAddr = vk.vkGetInstanceProcAddr;
    functions.vkGetDeviceProcAddr = vk.vkGetDeviceProcAddr;
    VmaAllocatorCreateInfo info{};
    info.flags = VMA_ALLOCATOR_CREATE_BUFFER_DEVICE_ADDRESS_BIT | VMA_ALLOCATOR_CREATE_EXTERNALLY_SYNCHRONIZED_BIT;
    info.instance = instance;
    info.physicalDevice = physical_device;
    info.device = device;
    info.vulkanApiVersion = api_version;
    info.pVulkanFunctions = &functions;
    info.preferredLargeHeapBlockSize = block_bytes;
    VmaAllocator allocator = nullptr;
    vk_check(vmaCreateAllocator(&info, &allocator), "create the memory allocator");
    return allocator;
}

void destroy_vma(VmaAllocator allocator) { vmaDestroyAllocator(allocator); }

AllocatorHooks vma_hooks(VmaAllocator allocator) { return hooks_of(allocator); }

}  // namespace twinray
