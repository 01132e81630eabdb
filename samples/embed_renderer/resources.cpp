// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/resources.h"

#include <vk_mem_alloc.h>

#include <utility>

namespace twinray::embed_renderer {
namespace {

VmaAllocationCreateInfo memory_for(HostBuffer::Access access) {
    VmaAllocationCreateInfo memory{};
    memory.usage = VMA_MEMORY_USAGE_AUTO;
    if (access == HostBuffer::Access::gpu) return memory;
    memory.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT |
                   (access == HostBuffer::Access::uploaded ? VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT
                                                           : VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT);
    memory.requiredFlags = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    return memory;
}

bool is_depth(VkFormat format) { return format == VK_FORMAT_D32_SFLOAT; }

}  // namespace

HostBuffer::HostBuffer(const Device& device, std::uint64_t bytes, Access access)
    : allocator_(device.allocator()), bytes_(bytes) {
    if (bytes == 0) return;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VmaAllocationCreateInfo memory = memory_for(access);
    VmaAllocationInfo allocated{};
    require(vmaCreateBuffer(allocator_, &info, &memory, &handle_, &allocation_, &allocated), "create a buffer");
    mapped_ = allocated.pMappedData;
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = handle_;
    address_ = vkGetBufferDeviceAddress(device.handle(), &address);
}

HostBuffer::~HostBuffer() {
    if (handle_) vmaDestroyBuffer(allocator_, handle_, allocation_);
}

HostBuffer& HostBuffer::operator=(HostBuffer&& other) noexcept {
    std::swap(allocator_, other.allocator_);
    std::swap(allocation_, other.allocation_);
    std::swap(handle_, other.handle_);
    std::swap(address_, other.address_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
    return *this;
}

HostImage::HostImage(const Device& device, VkFormat format, VkExtent2D size, VkImageUsageFlags usage)
    : device_(&device), format_(format) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {size.width, size.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    const VmaAllocationCreateInfo memory = memory_for(HostBuffer::Access::gpu);
    require(vmaCreateImage(device.allocator(), &info, &memory, &handle_, &allocation_, nullptr), "create an image");
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = handle_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange.aspectMask = is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    view.subresourceRange.levelCount = 1;
    view.subresourceRange.layerCount = 1;
    const VkResult result = vkCreateImageView(device.handle(), &view, nullptr, &view_);
    if (result != VK_SUCCESS) vmaDestroyImage(device.allocator(), handle_, allocation_);
    require(result, "create an image view");
}

HostImage::~HostImage() {
    if (!handle_) return;
    vkDestroyImageView(device_->handle(), view_, nullptr);
    vmaDestroyImage(device_->allocator(), handle_, allocation_);
}

HostImage& HostImage::operator=(HostImage&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(allocation_, other.allocation_);
    std::swap(handle_, other.handle_);
    std::swap(view_, other.view_);
    std::swap(format_, other.format_);
    return *this;
}

}  // namespace twinray::embed_renderer
