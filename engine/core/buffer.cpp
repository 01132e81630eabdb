// SPDX-License-Identifier: MIT
#include "engine/core/buffer.h"

#include <utility>

#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_VULKAN_VERSION 1003000
#include <vk_mem_alloc.h>

#include "engine/core/error.h"

namespace twinray {
namespace {

VmaAllocationCreateInfo allocation_info(Memory memory) {
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

VkBufferUsageFlags usage_of(const Context& context, const BufferDesc& desc) {
    VkBufferUsageFlags usage = desc.usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    if (context.facts().acceleration_structure)
        usage |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    return usage;
}

}  // namespace

Buffer::Buffer(Context& context, const BufferDesc& desc) : context_(&context), bytes_(desc.bytes), name_(desc.name) {
    if (name_.empty()) fail("buffer of ", bytes_, " bytes: a name is required");
    if (bytes_ == 0) return;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes_;
    info.usage = usage_of(context, desc);
    const VmaAllocationCreateInfo allocation = allocation_info(desc.memory);
    VmaAllocationInfo allocated{};
    const VkResult result = vmaCreateBufferWithAlignment(context.allocator(), &info, &allocation, desc.alignment,
                                                         &handle_, &allocation_, &allocated);
    if (result != VK_SUCCESS) fail("buffer '", name_, "' of ", bytes_, " bytes: ", name_of(result));
    mapped_ = static_cast<std::byte*>(allocated.pMappedData);
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = handle_;
    address_ = context.vk().vkGetBufferDeviceAddress(context.device(), &address);
    context.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(handle_), name_);
}

Buffer::~Buffer() {
    if (!handle_) return;
    context_->retire([allocator = context_->allocator(), handle = handle_, allocation = allocation_] {
        vmaDestroyBuffer(allocator, handle, allocation);
    });
}

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(handle_, other.handle_);
    std::swap(allocation_, other.allocation_);
    std::swap(address_, other.address_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
    std::swap(name_, other.name_);
    return *this;
}

}  // namespace twinray
