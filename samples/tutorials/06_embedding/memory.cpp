// SPDX-License-Identifier: MIT
#include "device.h"

#include <cstring>
#include <stdexcept>
#include <utility>

namespace renderer {
namespace {

VkDeviceMemory allocated(const Device& device, const VkMemoryRequirements& needed, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(device.physical(), &types);
    const auto fits = [&](std::uint32_t i) {
        return (needed.memoryTypeBits >> i & 1u) && (types.memoryTypes[i].propertyFlags & flags) == flags;
    };
    std::uint32_t type = 0;
    while (type < types.memoryTypeCount && !fits(type)) ++type;
    if (type == types.memoryTypeCount) throw std::runtime_error("no memory is of the kind that the renderer needs");
    auto by_address = of_type<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
    by_address.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    auto info = of_type<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.pNext = &by_address;
    info.allocationSize = needed.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    require(vkAllocateMemory(device.handle(), &info, nullptr, &memory), "allocate memory");
    return memory;
}

}  // namespace

// [buffer]
Buffer::Buffer(const Device& device, VkDeviceSize bytes, Place place, VkBufferUsageFlags more_usage)
    : device_(&device), bytes_(bytes) {
    auto info = of_type<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | more_usage;
    // [/buffer]
    require(vkCreateBuffer(device.handle(), &info, nullptr, &handle_), "create a buffer");
    VkMemoryRequirements needed;
    vkGetBufferMemoryRequirements(device.handle(), handle_, &needed);
    const bool is_mapped = place == Place::host;
    memory_ = allocated(device, needed,
                        is_mapped ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                  : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    require(vkBindBufferMemory(device.handle(), handle_, memory_, 0), "bind memory");
    if (is_mapped) require(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "map memory");
    auto asked = of_type<VkBufferDeviceAddressInfo>(VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO);
    asked.buffer = handle_;
    address_ = vkGetBufferDeviceAddress(device.handle(), &asked);
}

Buffer::~Buffer() {
    if (!device_) return;
    vkDestroyBuffer(device_->handle(), handle_, nullptr);
    vkFreeMemory(device_->handle(), memory_, nullptr);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    std::swap(address_, other.address_);
    std::swap(mapped_, other.mapped_);
    return *this;
}

Buffer uploaded(const Device& device, std::span<const std::byte> data) {
    const Buffer staging(device, data.size(), Buffer::Place::host);
    std::memcpy(staging.mapped(), data.data(), data.size());
    Buffer buffer(device, data.size());
    device.run_once([&](VkCommandBuffer commands) {
        const VkBufferCopy all{0, 0, data.size()};
        vkCmdCopyBuffer(commands, staging.handle(), buffer.handle(), 1, &all);
    });
    return buffer;
}

Image::Image(const Device& owner, VkFormat format, VkExtent2D size, VkImageUsageFlags usage, VkImageAspectFlags aspect)
    : device(owner) {
    auto info = of_type<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {size.width, size.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    require(vkCreateImage(device.handle(), &info, nullptr, &handle), "create an image");
    VkMemoryRequirements needed;
    vkGetImageMemoryRequirements(device.handle(), handle, &needed);
    memory = allocated(device, needed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    require(vkBindImageMemory(device.handle(), handle, memory, 0), "bind memory");
    auto view_info = of_type<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view_info.image = handle;
    view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = format;
    view_info.subresourceRange = {aspect, 0, 1, 0, 1};
    require(vkCreateImageView(device.handle(), &view_info, nullptr, &view), "create a view");
}

Image::~Image() {
    vkDestroyImageView(device.handle(), view, nullptr);
    vkDestroyImage(device.handle(), handle, nullptr);
    vkFreeMemory(device.handle(), memory, nullptr);
}

}  // namespace renderer
