// SPDX-License-Identifier: MIT
#define VMA_IMPLEMENTATION
#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_VULKAN_VERSION 1003000
#include <vulkan/vulkan_core.h>

#include <vk_mem_alloc.h>

#include "engine/core/vma.h"
#include "engine/core/vma_adapter.h"

namespace twinray {
namespace {

// Of the blocks that buffers are cut from. Memory that was freed is used again within a block, while a buffer of more
// than half a block has its own, which goes back to the driver. A driver on a CPU gets memory from the operating system
// page by page, at 2.6 us each (measured on a virtual machine), when it is touched first: a block costs only what was
// used of it, but keeps that while anything lies in it, and one empty block is kept, too.
VkDeviceSize block_size(const VulkanFunctions& vk, VkPhysicalDevice physical_device) {
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    vk.vkGetPhysicalDeviceProperties2(physical_device, &properties);
    const bool is_cpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    return is_cpu ? VkDeviceSize{2} << 30 : 0;  // 0: VMA's own choice
}

}  // namespace

VmaAllocator create_vma(const VulkanFunctions& vk, VkInstance instance, VkPhysicalDevice physical_device,
                        VkDevice device, std::uint32_t api_version) {
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
    info.preferredLargeHeapBlockSize = block_size(vk, physical_device);
    VmaAllocator allocator = nullptr;
    vk_check(vmaCreateAllocator(&info, &allocator), "create the memory allocator");
    return allocator;
}

void destroy_vma(VmaAllocator allocator) { vmaDestroyAllocator(allocator); }

AllocatorHooks vma_hooks(VmaAllocator allocator) { return hooks_of(allocator); }

}  // namespace twinray
