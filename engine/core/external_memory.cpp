// SPDX-License-Identifier: MIT
#include "engine/core/external_memory.h"

#include <unistd.h>

#include "engine/core/error.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

constexpr VkExternalMemoryHandleTypeFlagBits opaque_fd = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;

VkBuffer new_buffer(const VulkanTable& vk, VkDevice device, std::uint64_t bytes, VkBufferUsageFlags usage) {
    VkExternalMemoryBufferCreateInfo external{};
    external.sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO;
    external.handleTypes = opaque_fd;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.pNext = &external;
    info.size = bytes;
    info.usage = usage;
    VkBuffer buffer = VK_NULL_HANDLE;
    vk_check(vk.vkCreateBuffer(device, &info, nullptr, &buffer), "create a shared buffer");
    return buffer;
}

// The first type of those allowed that is the device's own.
std::uint32_t memory_type(const Context::State& state, std::uint32_t allowed) {
    VkPhysicalDeviceMemoryProperties properties{};
    state.vk().vkGetPhysicalDeviceMemoryProperties(state.physical_device(), &properties);
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i)
        if ((allowed >> i & 1u) && (properties.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))
            return i;
    fail("no memory of the device's own can be shared");
}

VkDeviceMemory new_memory(const Context::State& state, std::uint32_t type, std::uint64_t bytes, int fd) {
    VkImportMemoryFdInfoKHR import{};
    import.sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR;
    import.handleType = opaque_fd;
    import.fd = fd;
    VkExportMemoryAllocateInfo exports{};
    exports.sType = VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO;
    exports.handleTypes = opaque_fd;
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.pNext = fd < 0 ? static_cast<const void*>(&exports) : &import;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.pNext = &flags;
    info.allocationSize = bytes;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    const VkResult result = state.vk().vkAllocateMemory(state.device(), &info, nullptr, &memory);
    if (result != VK_SUCCESS && fd >= 0) close(fd);
    vk_check(result, fd < 0 ? "allocate memory to be shared" : "import memory");
    return memory;
}

// What is imported belongs to the driver, whatever fails then.
int copy_of(int fd) {
    if (fd < 0) return fd;
    const int copy = dup(fd);
    if (copy < 0) fail("file descriptor ", fd, " cannot be copied");
    return copy;
}

}  // namespace

ExternalBuffer make_external(Context& context, const BufferDesc& desc, VkBufferUsageFlags usage,
                             const ExportedMemory& imported) try {
    const Context::State& state = context.state();
    if (!state.properties().external_memory_fd)
        fail("device '", state.properties().name, "' has not enabled VK_KHR_external_memory_fd");
    if (desc.memory != Memory::device) fail("only memory of the device can be shared");
    if (desc.bytes == 0) fail("0 bytes cannot be shared");
    ExternalBuffer made{new_buffer(state.vk(), state.device(), desc.bytes, usage), {}};
    try {
        VkMemoryRequirements needs{};
        state.vk().vkGetBufferMemoryRequirements(state.device(), made.buffer, &needs);
        made.memory.bytes = imported.fd >= 0 ? imported.bytes : needs.size;
        if (made.memory.bytes < needs.size)
            fail(made.memory.bytes, " bytes were exported; ", needs.size, " are needed");
        made.memory.memory =
            new_memory(state, memory_type(state, needs.memoryTypeBits), made.memory.bytes, copy_of(imported.fd));
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

void free_external(const Context::State& state, const ExternalBuffer& buffer) {
    state.vk().vkDestroyBuffer(state.device(), buffer.buffer, nullptr);
    state.vk().vkFreeMemory(state.device(), buffer.memory.memory, nullptr);
}

int export_fd(const Context::State& state, VkDeviceMemory memory, const std::string& name) {
    if (!memory) fail("buffer '", name, "' is not exportable");
    VkMemoryGetFdInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR;
    info.memory = memory;
    info.handleType = opaque_fd;
    int fd = -1;
    vk_check(state.vk().vkGetMemoryFdKHR(state.device(), &info, &fd), "export memory");
    return fd;
}

}  // namespace twinray
