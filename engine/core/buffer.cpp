#include "engine/core/commands.h"

#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

// A buffer whose memory other programs and APIs share.
struct ExternalBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    ExternalMemory memory;
};

VkBuffer new_buffer(const VulkanTable& vk, VkDevice device, std::uint64_t bytes, VkBufferUsageFlags usage) {
    VkExternalMemoryBufferCreateInfo external = OfType{VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO};
    external.handleTypes = platform::shared_memory.type;
    VkBufferCreateInfo info = OfType{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.pNext = &external;
    info.size = bytes;
    info.usage = usage;
    return created(vk.vkCreateBuffer, device, info, "create a shared buffer");
}

// Returns the first allowed type in the device's own memory.
std::uint32_t memory_type(const Context::State& state, std::uint32_t allowed) {
    VkPhysicalDeviceMemoryProperties properties{};
    state.vk().vkGetPhysicalDeviceMemoryProperties(state.physical_device(), &properties);
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i)
        if ((allowed >> i & 1u) && (properties.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))
            return i;
    fail("no memory of the device's own can be shared");
}

// Makes memory to be exported or, with a handle, imports that.
VkDeviceMemory new_memory(const Context::State& state, std::uint32_t type, std::uint64_t bytes, std::intptr_t handle) {
    VkExportMemoryAllocateInfo exports = OfType{VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO};
    exports.handleTypes = platform::shared_memory.type;
    VkMemoryAllocateFlagsInfo flags = OfType{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info = OfType{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.pNext = &flags;
    info.allocationSize = bytes;
    info.memoryTypeIndex = type;
    const PFN_vkAllocateMemory allocate = state.vk().vkAllocateMemory;
    if (handle == platform::no_handle) {
        flags.pNext = &exports;
        return created(allocate, state.device(), info, "allocate memory to be shared");
    }
    VkDeviceMemory memory = VK_NULL_HANDLE;
    // A copy, because the driver owns an imported file descriptor, whatever fails then.
    const std::intptr_t copy = platform::copy_handle(handle);
    if (copy == platform::no_handle) fail("handle ", handle, " cannot be copied");
    const VkResult result = platform::import_memory(allocate, state.device(), info, copy, memory);
    if (result != VK_SUCCESS || !platform::shared_memory.is_taken_over) platform::close_handle(copy);
    vk_check(result, "import memory");
    return memory;
}

void free_external(const Context::State& state, const ExternalBuffer& buffer) {
    state.vk().vkDestroyBuffer(state.device(), buffer.buffer, nullptr);
    state.vk().vkFreeMemory(state.device(), buffer.memory.memory, nullptr);
}

// Makes memory to be exported or, with a handle, imports another's export. Throws Error naming the buffer.
ExternalBuffer make_external(Context& context, const BufferDesc& desc, VkBufferUsageFlags usage,
                             const ExportedMemory& imported) try {
    const Context::State& state = context.state();
    if (!state.properties().external_memory)
        fail("device '", state.properties().name, "' has not enabled ", platform::shared_memory.extension);
    if (desc.memory != Memory::device) fail("only memory of the device can be shared");
    if (desc.bytes == 0) fail("0 bytes cannot be shared");
    ExternalBuffer made{new_buffer(state.vk(), state.device(), desc.bytes, usage), {}};
    try {
        VkMemoryRequirements needs{};
        state.vk().vkGetBufferMemoryRequirements(state.device(), made.buffer, &needs);
        made.memory.bytes = imported.handle == platform::no_handle ? needs.size : imported.bytes;
        if (made.memory.bytes < needs.size)
            fail(made.memory.bytes, " bytes were exported; ", needs.size, " are needed");
        made.memory.memory =
            new_memory(state, memory_type(state, needs.memoryTypeBits), made.memory.bytes, imported.handle);
        vk_check(state.vk().vkBindBufferMemory(state.device(), made.buffer, made.memory.memory, 0), "bind memory");
    } catch (...) {
        free_external(state, made);
        throw;
    }
    return made;
} catch (const DeviceLost&) {
    throw;
} catch (const Error& error) {
    fail("buffer '", desc.name, "' to be shared: ", error.what());
}

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
    context.state().check_process();
    if (bytes_ == 0) return;
    made_ = context.state().allocator().allocate(
        {name_.c_str(), bytes_, usage_of(context, desc), desc.memory, desc.alignment});
    take_address(desc.alignment);
}

Buffer::Buffer(Context& context, const BufferDesc& desc, const ExportedMemory& memory)
    : context_(&context), bytes_(desc.bytes), name_(desc.name) {
    if (name_.empty()) fail("buffer of ", bytes_, " bytes: a name is required");
    context.state().check_process();
    const ExternalBuffer made = make_external(context, desc, usage_of(context, desc), memory);
    made_.buffer = made.buffer;
    external_ = made.memory;
    take_address(desc.alignment);
}

Buffer Buffer::exportable(Context& context, const BufferDesc& desc) { return {context, desc, ExportedMemory{}}; }
Buffer Buffer::imported(Context& context, const BufferDesc& desc, const ExportedMemory& memory) {
    if (memory.handle == platform::no_handle) fail("buffer '", desc.name, "' to be shared: no handle");
    Buffer made(context, desc, memory);
    platform::close_handle(memory.handle);
    return made;
}

ExportedMemory Buffer::exported() const {
    if (!context_) fail("a buffer without memory is not exportable");
    if (!external_.memory) fail("buffer '", name_, "' is not exportable");
    const Context::State& state = context_->state();
    const PFN_vkVoidFunction get = state.vk().vkGetDeviceProcAddr(state.device(), platform::shared_memory.get_handle);
    std::intptr_t handle = platform::no_handle;
    vk_check(platform::export_memory(get, state.device(), external_.memory, handle), "export memory");
    return {handle, external_.bytes};
}

void Buffer::take_address(std::uint64_t alignment) {
    Context& context = *context_;
    VkBufferDeviceAddressInfo address = OfType{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
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
