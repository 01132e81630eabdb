// SPDX-License-Identifier: MIT
// Where the memory of buffers comes from: an allocator of twinray's own, or the host's through two functions.
#pragma once

#include <cstdint>

#include <vulkan/vulkan_core.h>

typedef struct VmaAllocator_T* VmaAllocator;

namespace twinray {

struct VulkanFunctions;

enum class Memory : std::uint8_t {
    device,    // fastest for the GPU, not mapped
    upload,    // host writes once, GPU reads
    readback,  // GPU writes, host reads
};

// What twinray asks of an allocator: a buffer bound to memory of its own.
struct BufferRequest {
    const char* name = "";         // for debugging; valid during the call
    std::uint64_t bytes = 0;       // not 0
    VkBufferUsageFlags usage = 0;  // with SHADER_DEVICE_ADDRESS: the memory needs VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT
    Memory memory = Memory::device;
    std::uint64_t alignment = 1;  // of the device address; a power of two
};

// What it gets.
struct AllocatedBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    // Memory::upload and readback: where the host reads and writes it, coherently, until it is freed.
    void* mapped = nullptr;
    void* allocation = nullptr;  // the allocator's own; twinray only hands it back
};

// What twinray asks of an allocator for textures: an image bound to memory of its own.
struct ImageRequest {
    const char* name = "";  // for debugging; valid during the call
    const VkImageCreateInfo* info = nullptr;
};

struct AllocatedImage {
    VkImage image = VK_NULL_HANDLE;
    std::uint64_t bytes = 0;     // of its memory
    void* allocation = nullptr;  // the allocator's own; twinray only hands it back
};

// The host's allocator. Plain functions and plain data, so that no version of any allocator's types crosses the border
// of the library; engine/core/vma_adapter.h makes them of a VmaAllocator. They are called on the thread that uses the
// Context and must not throw.
struct AllocatorHooks {
    // Returns VK_SUCCESS and fills `result`, or the error and leaves nothing behind.
    VkResult (*allocate)(void* user, const BufferRequest& request, AllocatedBuffer& result) = nullptr;
    // The GPU no longer uses the buffer.
    void (*free)(void* user, const AllocatedBuffer& buffer) = nullptr;
    void* user = nullptr;
    // The same for images in the device's memory. Both may be null: then textures are kept in buffers.
    VkResult (*allocate_image)(void* user, const ImageRequest& request, AllocatedImage& result) = nullptr;
    void (*free_image)(void* user, const AllocatedImage& image) = nullptr;
};

// The one door through which buffers and images are made and freed.
class Allocator {
  public:
    // The host's. Throws Error if one hook is missing.
    explicit Allocator(const AllocatorHooks& hooks);
    // twinray's own.
    Allocator(const VulkanFunctions& vk, VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
              std::uint32_t api_version, std::uint64_t block_bytes);
    ~Allocator();  // every buffer must have been freed
    Allocator(const Allocator&) = delete;
    Allocator& operator=(const Allocator&) = delete;

    // Throws Error naming the buffer and its size when there is no memory or the host's hook breaks its promise.
    AllocatedBuffer allocate(const BufferRequest& request);
    void free(const AllocatedBuffer& buffer, std::uint64_t bytes) noexcept;

    bool has_images() const { return hooks_.allocate_image && hooks_.free_image; }
    // Likewise; has_images() must be true.
    AllocatedImage allocate(const ImageRequest& request);
    void free(const AllocatedImage& image) noexcept;

    std::uint64_t live_bytes() const { return live_bytes_; }

  private:
    VmaAllocator own_ = nullptr;  // null: the host's
    AllocatorHooks hooks_;
    std::uint64_t live_bytes_ = 0;
};

// Bytes of the buffers that are alive, as they were asked for, and of the images' memory.
inline std::uint64_t allocated_bytes(const Allocator& allocator) { return allocator.live_bytes(); }

}  // namespace twinray
