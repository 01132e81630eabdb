// SPDX-License-Identifier: MIT
// The source of buffers' memory: an allocator of twinray's own, or the application's through two functions.
#pragma once

#include <twinray/context.h>

typedef struct VmaAllocator_T* VmaAllocator;

namespace twinray {

struct VulkanTable;

// Makes and frees all buffers and images.
class Allocator {
  public:
    // Uses the application's allocator. Throws Error if one hook is missing.
    explicit Allocator(const AllocatorHooks& hooks);
    // Uses twinray's own.
    Allocator(const VulkanTable& vk, VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
              std::uint32_t api_version, std::uint64_t block_bytes);
    ~Allocator();  // every buffer must have been freed
    Allocator(const Allocator&) = delete;
    Allocator& operator=(const Allocator&) = delete;

    // Throws Error naming the buffer and its size if there is no memory or the application's hook breaks its promise.
    AllocatedBuffer allocate(const BufferRequest& request);
    void free(const AllocatedBuffer& buffer, std::uint64_t bytes) noexcept;

    bool has_images() const { return hooks_.allocate_image && hooks_.free_image; }
    // The same for images; has_images() must be true.
    AllocatedImage allocate(const ImageRequest& request);
    void free(const AllocatedImage& image) noexcept;

    std::uint64_t live_bytes() const { return live_bytes_; }

  private:
    VmaAllocator own_ = nullptr;  // null: the host's
    AllocatorHooks hooks_;
    std::uint64_t live_bytes_ = 0;
};

}  // namespace twinray
