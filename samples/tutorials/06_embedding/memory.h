// SPDX-License-Identifier: MIT
// Buffers and images of the renderer, each with memory of its own.
#pragma once

#include <span>

#include "device.h"

namespace renderer {

// A buffer that shaders reach by its address. Move-only.
class Buffer {
  public:
    enum class Place { device, host };  // host: mapped, coherent
    Buffer() = default;
    // more_usage: further usage beyond storage, transfer and device address.
    Buffer(const Device& device, VkDeviceSize bytes, Place place = Place::device, VkBufferUsageFlags more_usage = 0);
    ~Buffer();
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;

    VkBuffer handle() const { return handle_; }
    VkDeviceSize bytes() const { return bytes_; }
    VkDeviceAddress address() const { return address_; }
    void* mapped() const { return mapped_; }

  private:
    const Device* device_ = nullptr;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize bytes_ = 0;
    VkDeviceAddress address_ = 0;
    void* mapped_ = nullptr;
};

// Returns a buffer in the device's memory with the data; waits for the upload.
Buffer uploaded(const Device& device, std::span<const std::byte> data);

// A render target. Not copied.
struct Image {
    Image(const Device& owner, VkFormat format, VkExtent2D size, VkImageUsageFlags usage, VkImageAspectFlags aspect);
    ~Image();
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;

    const Device& device;
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
};

}  // namespace renderer
