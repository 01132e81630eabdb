// SPDX-License-Identifier: MIT
#include "engine/core/allocator.h"

#include "engine/core/error.h"
#include "engine/core/vma.h"
#include "engine/core/vulkan.h"

namespace twinray {

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
