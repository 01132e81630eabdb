// SPDX-License-Identifier: MIT
// Buffers and images of the renderer, in memory of its own allocator.
#pragma once

#include <cstring>
#include <span>

#include "twinray/glsl/cpp.h"
#include "samples/embed_renderer/device.h"

typedef struct VmaAllocation_T* VmaAllocation;

namespace twinray::embed_renderer {

// Storage that shaders reach by address; move-only.
class HostBuffer {
  public:
    enum class Access { gpu, uploaded, read_back };
    HostBuffer() = default;
    HostBuffer(const Device& device, std::uint64_t bytes, Access access = Access::gpu);
    ~HostBuffer();
    HostBuffer(HostBuffer&& other) noexcept { *this = std::move(other); }
    HostBuffer& operator=(HostBuffer&& other) noexcept;

    VkBuffer handle() const { return handle_; }
    std::uint64_t bytes() const { return bytes_; }
    void* mapped() const { return mapped_; }  // null for Access::gpu
    template <class T>
    Ref<T> ref(std::uint64_t index = 0) const {
        return {address_ + index * sizeof(T)};
    }

  private:
    VmaAllocator allocator_ = nullptr;
    VmaAllocation allocation_ = nullptr;
    VkBuffer handle_ = VK_NULL_HANDLE;
    std::uint64_t address_ = 0;
    std::uint64_t bytes_ = 0;
    void* mapped_ = nullptr;
};

// A target of the rasteriser; move-only.
class HostImage {
  public:
    HostImage() = default;
    HostImage(const Device& device, VkFormat format, VkExtent2D size, VkImageUsageFlags usage);
    ~HostImage();
    HostImage(HostImage&& other) noexcept { *this = std::move(other); }
    HostImage& operator=(HostImage&& other) noexcept;

    VkImageView view() const { return view_; }
    VkFormat format() const { return format_; }

  private:
    const Device* device_ = nullptr;
    VmaAllocation allocation_ = nullptr;
    VkImage handle_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
};

}  // namespace twinray::embed_renderer
