#include "engine/core/context.h"

#include <algorithm>
#include <cstdlib>

#include "engine/core/vulkan.h"

namespace twinray {
namespace {

// Blocks of the heap are their handles; with so many bits between them, addresses are unlikely to overlap.
constexpr unsigned address_shift = 8;

template <class Handle>
VkResult make(Handle& handle, std::uint64_t bytes = 1) {
    void* block = std::calloc(bytes, 1);
    handle = reinterpret_cast<Handle>(block);
    return block ? VK_SUCCESS : VK_ERROR_OUT_OF_HOST_MEMORY;
}

template <class Handle>
void release(Handle handle) {
    std::free(reinterpret_cast<void*>(handle));
}

template <class Handle>
std::uint64_t address_of(Handle handle) {
    return reinterpret_cast<std::uint64_t>(handle) << address_shift;
}

template <class... Arguments>
void mute(void(VKAPI_PTR*& command)(VkCommandBuffer, Arguments...)) {
    if (command) command = [](VkCommandBuffer, Arguments...) {};
}

template <class... Arguments>
void succeed(VkResult(VKAPI_PTR*& function)(Arguments...)) {
    function = [](Arguments...) { return VK_SUCCESS; };
}

template <class Info, class Handle>
void pretend(VkResult(VKAPI_PTR*& create)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
             void(VKAPI_PTR*& destroy)(VkDevice, Handle, const VkAllocationCallbacks*)) {
    create = [](VkDevice, const Info*, const VkAllocationCallbacks*, Handle* handle) { return make(*handle); };
    destroy = [](VkDevice, Handle handle, const VkAllocationCallbacks*) { release(handle); };
}

void mute_commands(VulkanTable& vk) {
    mute(vk.vkCmdResetQueryPool);
    mute(vk.vkCmdCopyQueryPoolResults);
    mute(vk.vkCmdWriteTimestamp);
    mute(vk.vkCmdBindPipeline);
    mute(vk.vkCmdPushConstants);
    mute(vk.vkCmdBindDescriptorSets);
    mute(vk.vkCmdCopyBufferToImage);
    mute(vk.vkCmdBuildAccelerationStructuresKHR);
    mute(vk.vkCmdWriteAccelerationStructuresPropertiesKHR);
    mute(vk.vkCmdCopyAccelerationStructureKHR);
    mute(vk.vkCmdCopyAccelerationStructureToMemoryKHR);
    mute(vk.vkCmdCopyMemoryToAccelerationStructureKHR);
    mute(vk.vkCmdTraceRaysKHR);
    mute(vk.vkCmdBeginDebugUtilsLabelEXT);
    mute(vk.vkCmdEndDebugUtilsLabelEXT);
    vk.vkSetDebugUtilsObjectNameEXT = nullptr;
}

thread_local RecordedWork recorded;

template <std::uint64_t RecordedWork::*number, class... Arguments>
void tally(void(VKAPI_PTR*& command)(VkCommandBuffer, Arguments...)) {
    command = [](VkCommandBuffer, Arguments...) { ++(recorded.*number); };
}

void record_nothing(VulkanTable& vk) {
    mute_commands(vk);
    tally<&RecordedWork::dispatches>(vk.vkCmdDispatch);
    tally<&RecordedWork::dispatches>(vk.vkCmdDispatchIndirect);
    tally<&RecordedWork::barriers>(vk.vkCmdPipelineBarrier);
    tally<&RecordedWork::copies>(vk.vkCmdCopyBuffer);
    tally<&RecordedWork::copies>(vk.vkCmdFillBuffer);
    tally<&RecordedWork::copies>(vk.vkCmdUpdateBuffer);
    pretend(vk.vkCreateCommandPool, vk.vkDestroyCommandPool);
    vk.vkAllocateCommandBuffers = [](VkDevice, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* buffers) {
        std::fill_n(buffers, info->commandBufferCount, VkCommandBuffer{});
        return VK_SUCCESS;
    };
    succeed(vk.vkBeginCommandBuffer);
    succeed(vk.vkEndCommandBuffer);
    pretend(vk.vkCreateQueryPool, vk.vkDestroyQueryPool);
    succeed(vk.vkGetQueryPoolResults);
}

void pass_at_once(VulkanTable& vk) {
    succeed(vk.vkQueueSubmit);
    pretend(vk.vkCreateSemaphore, vk.vkDestroySemaphore);
    succeed(vk.vkWaitSemaphores);
    vk.vkGetSemaphoreCounterValue = [](VkDevice, VkSemaphore, std::uint64_t* value) {
        *value = UINT64_MAX;
        return VK_SUCCESS;
    };
}

void hold_nothing(VulkanTable& vk) {
    vk.vkGetBufferDeviceAddress = [](VkDevice, const VkBufferDeviceAddressInfo* info) {
        return VkDeviceAddress{address_of(info->buffer)};
    };
    if (!vk.vkCreateAccelerationStructureKHR) return;
    pretend(vk.vkCreateAccelerationStructureKHR, vk.vkDestroyAccelerationStructureKHR);
    vk.vkGetAccelerationStructureDeviceAddressKHR = [](VkDevice,
                                                       const VkAccelerationStructureDeviceAddressInfoKHR* info) {
        return VkDeviceAddress{address_of(info->accelerationStructure)};
    };
}

VkResult allocate_buffer(void*, const BufferRequest& request, AllocatedBuffer& result) {
    const bool is_mapped = request.memory != Memory::device;
    const VkResult made = make(result.buffer, is_mapped ? request.bytes : 1);
    if (is_mapped) result.mapped = reinterpret_cast<void*>(result.buffer);
    return made;
}

void free_buffer(void*, const AllocatedBuffer& buffer) { release(buffer.buffer); }

}  // namespace

RecordedWork take_recorded_work() { return std::exchange(recorded, {}); }

void run_nothing(VulkanTable& vk) {
    record_nothing(vk);
    pass_at_once(vk);
    hold_nothing(vk);
}

AllocatorHooks memoryless_allocator() {
    AllocatorHooks hooks;
    hooks.allocate = allocate_buffer;
    hooks.free = free_buffer;
    return hooks;
}

}  // namespace twinray
