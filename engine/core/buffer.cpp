// SPDX-License-Identifier: MIT
#include "engine/core/buffer.h"

#include <unistd.h>

#include <utility>

#include "engine/core/error.h"
#include "engine/core/external_memory.h"
#include "engine/core/vulkan.h"

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

void release(Context::State& state, const AllocatedBuffer& made, const ExternalMemory& external, std::uint64_t bytes) {
    if (external.memory) return free_external(state, {made.buffer, external});
    state.allocator().free(made, bytes);
}

}  // namespace

Buffer::Buffer(Context& context, const BufferDesc& desc) : context_(&context), bytes_(desc.bytes), name_(desc.name) {
    if (name_.empty()) fail("buffer of ", bytes_, " bytes: a name is required");
    if (bytes_ == 0) return;
    made_ = context.state().allocator().allocate(
        {name_.c_str(), bytes_, usage_of(context, desc), desc.memory, desc.alignment});
    take_address(desc.alignment);
}

Buffer::Buffer(Context& context, const BufferDesc& desc, const ExportedMemory& memory)
    : context_(&context), bytes_(desc.bytes), name_(desc.name) {
    if (name_.empty()) fail("buffer of ", bytes_, " bytes: a name is required");
    const ExternalBuffer made = make_external(context, desc, usage_of(context, desc), memory);
    made_.buffer = made.buffer;
    external_ = made.memory;
    take_address(desc.alignment);
}

Buffer Buffer::exportable(Context& context, const BufferDesc& desc) { return {context, desc, ExportedMemory{}}; }
Buffer Buffer::imported(Context& context, const BufferDesc& desc, const ExportedMemory& memory) {
    if (memory.fd < 0) fail("buffer '", desc.name, "' to be shared: file descriptor ", memory.fd);
    Buffer made(context, desc, memory);
    close(memory.fd);
    return made;
}

ExportedMemory Buffer::exported() const {
    if (!context_) fail("a buffer without memory is not exportable");
    return {export_fd(context_->state(), external_.memory, name_), external_.bytes};
}

void Buffer::take_address(std::uint64_t alignment) {
    Context& context = *context_;
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = made_.buffer;
    address_ = context.state().vk().vkGetBufferDeviceAddress(context.device(), &address);
    if (!address_ || address_ % alignment) {
        release(context.state(), made_, external_, bytes_);
        fail("buffer '", name_, "' of ", bytes_, " bytes: the allocator gave the device address ", address_,
             "; it must be a multiple of ", alignment, " and not 0");
    }
    context.state().set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(made_.buffer), name_);
}

Buffer::~Buffer() {
    if (!made_.buffer) return;
    context_->state().retire([&state = context_->state(), made = made_, external = external_, bytes = bytes_] {
        release(state, made, external, bytes);
    });
}

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(made_, other.made_);
    std::swap(external_, other.external_);
    std::swap(address_, other.address_);
    std::swap(bytes_, other.bytes_);
    std::swap(name_, other.name_);
    return *this;
}

}  // namespace twinray
