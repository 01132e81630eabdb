// SPDX-License-Identifier: MIT
#include "engine/core/buffer.h"

#include <utility>

#include "engine/core/error.h"

namespace twinray {
namespace {

VkBufferUsageFlags usage_of(const Context& context, const BufferDesc& desc) {
    VkBufferUsageFlags usage = desc.usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                               VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    if (context.properties().acceleration_structure)
        usage |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    return usage;
}

}  // namespace

Buffer::Buffer(Context& context, const BufferDesc& desc) : context_(&context), bytes_(desc.bytes), name_(desc.name) {
    if (name_.empty()) fail("buffer of ", bytes_, " bytes: a name is required");
    if (bytes_ == 0) return;
    made_ = context.state().allocator().allocate(
        {name_.c_str(), bytes_, usage_of(context, desc), desc.memory, desc.alignment});
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = made_.buffer;
    address_ = context.state().vk().vkGetBufferDeviceAddress(context.device(), &address);
    if (!address_ || address_ % desc.alignment) {
        context.state().allocator().free(made_, bytes_);
        fail("buffer '", name_, "' of ", bytes_, " bytes: the allocator gave the device address ", address_,
             "; it must be a multiple of ", desc.alignment, " and not 0");
    }
    context.state().set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(made_.buffer), name_);
}

Buffer::~Buffer() {
    if (!made_.buffer) return;
    context_->state().retire(
        [&allocator = context_->state().allocator(), made = made_, bytes = bytes_] { allocator.free(made, bytes); });
}

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(made_, other.made_);
    std::swap(address_, other.address_);
    std::swap(bytes_, other.bytes_);
    std::swap(name_, other.name_);
    return *this;
}

}  // namespace twinray
