// SPDX-License-Identifier: MIT
// Makes AllocatorHooks from a VmaAllocator. The library does not contain this code: an application compiles it against
// its own version of the Vulkan Memory Allocator, whose header it includes first.
#pragma once

#ifndef AMD_VULKAN_MEMORY_ALLOCATOR_H
#error "include vk_mem_alloc.h before twinray/vma_adapter.h"
#endif

#include <twinray/context.h>

namespace twinray {
namespace vma_adapter {

inline VmaAllocationCreateInfo memory_info(Memory memory) {
    VmaAllocationCreateInfo info{};
    info.usage = VMA_MEMORY_USAGE_AUTO;
    if (memory == Memory::device) {
        info.usage = VMA_MEMORY_USAGE_AUTO_PREFER_DEVICE;
        return info;
    }
    info.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT |
                 (memory == Memory::upload ? VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT
                                           : VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT);
    info.requiredFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    return info;
}

inline VkResult allocate(void* user, const BufferRequest& request, AllocatedBuffer& result) {
    const auto allocator = static_cast<VmaAllocator>(user);
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = request.bytes;
    info.usage = request.usage;
    const VmaAllocationCreateInfo memory = memory_info(request.memory);
    VmaAllocation allocation = nullptr;
    VmaAllocationInfo allocated{};
    const VkResult made = vmaCreateBufferWithAlignment(allocator, &info, &memory, request.alignment, &result.buffer,
                                                       &allocation, &allocated);
    if (made != VK_SUCCESS) return made;
    vmaSetAllocationName(allocator, allocation, request.name);
    result.mapped = allocated.pMappedData;
    result.allocation = allocation;
    return VK_SUCCESS;
}

inline void free(void* user, const AllocatedBuffer& buffer) {
    vmaDestroyBuffer(static_cast<VmaAllocator>(user), buffer.buffer, static_cast<VmaAllocation>(buffer.allocation));
}

inline VkResult allocate_image(void* user, const ImageRequest& request, AllocatedImage& result) {
    const auto allocator = static_cast<VmaAllocator>(user);
    const VmaAllocationCreateInfo memory = memory_info(Memory::device);
    VmaAllocation allocation = nullptr;
    VmaAllocationInfo allocated{};
    const VkResult made = vmaCreateImage(allocator, request.info, &memory, &result.image, &allocation, &allocated);
    if (made != VK_SUCCESS) return made;
    vmaSetAllocationName(allocator, allocation, request.name);
    result.bytes = allocated.size;
    result.allocation = allocation;
    return VK_SUCCESS;
}

inline void free_image(void* user, const AllocatedImage& image) {
    vmaDestroyImage(static_cast<VmaAllocator>(user), image.image, static_cast<VmaAllocation>(image.allocation));
}

}  // namespace vma_adapter

// The allocator must have been created with VMA_ALLOCATOR_CREATE_BUFFER_DEVICE_ADDRESS_BIT, and outlive the Context.
inline AllocatorHooks hooks_of(VmaAllocator allocator) {
    return {&vma_adapter::allocate, &vma_adapter::free, allocator, &vma_adapter::allocate_image,
            &vma_adapter::free_image};
}

}  // namespace twinray
