// The only file that compiles the Vulkan Memory Allocator.
#define VMA_IMPLEMENTATION
#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_VULKAN_VERSION 1003000
#include <vulkan/vulkan_core.h>

#include <vk_mem_alloc.h>

#include "engine/core/context.h"
#include "engine/core/error.h"
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

Allocator::Allocator(const AllocatorHooks& hooks) : hooks_(hooks) {
    if (!hooks.allocate || !hooks.free) fail("allocator hooks: allocate and free must both be set");
}

Allocator::Allocator(const VulkanTable& vk, VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
                     std::uint32_t api_version, std::uint64_t block_bytes)
    : own_(create_vma(vk, instance, physical_device, device, api_version, block_bytes)), hooks_(vma_hooks(own_)) {}

Allocator::~Allocator() {
    if (own_) destroy_vma(own_);
}

AllocatedBuffer Allocator::allocate(const BufferRequest& request) {
    AllocatedBuffer made;
    const VkResult result = hooks_.allocate(hooks_.user, request, made);
    if (result != VK_SUCCESS) fail("buffer '", request.name, "' of ", request.bytes, " bytes: ", name_of(result));
    const bool lacks_mapping = request.memory != Memory::device && !made.mapped;
    if (made.buffer && !lacks_mapping) {
        live_bytes_ += request.bytes;
        return made;
    }
    if (made.buffer) hooks_.free(hooks_.user, made);
    fail("buffer '", request.name, "' of ", request.bytes, " bytes: the host's allocator reports success but gave ",
         made.buffer ? "memory that is not mapped" : "no buffer");
}

AllocatedImage Allocator::allocate(const ImageRequest& request) {
    AllocatedImage made;
    const VkResult result = hooks_.allocate_image(hooks_.user, request, made);
    if (result != VK_SUCCESS)
        fail("image '", request.name, "' of ", request.info->extent.width, " x ", request.info->extent.height, ": ",
             name_of(result));
    if (!made.image) fail("image '", request.name, "': the host's allocator reports success but gave no image");
    live_bytes_ += made.bytes;
    return made;
}

void Allocator::free(const AllocatedImage& image) noexcept {
    hooks_.free_image(hooks_.user, image);
    live_bytes_ -= image.bytes;
}

void Allocator::free(const AllocatedBuffer& buffer, std::uint64_t bytes) noexcept {
    hooks_.free(hooks_.user, buffer);
    live_bytes_ -= bytes;
}

}  // namespace twinray
