// SPDX-License-Identifier: MIT
#include "engine/core/dry_device.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

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

template <class... Rest>
void mute(void(VKAPI_PTR*& command)(VkCommandBuffer, Rest...)) {
    if (command) command = [](VkCommandBuffer, Rest...) {};
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

void count_commands(VulkanTable& vk) {
    vk.vkCmdDispatch = [](VkCommandBuffer, std::uint32_t, std::uint32_t, std::uint32_t) { ++recorded.dispatches; };
    vk.vkCmdDispatchIndirect = [](VkCommandBuffer, VkBuffer, VkDeviceSize) { ++recorded.dispatches; };
    vk.vkCmdPipelineBarrier = [](VkCommandBuffer, VkPipelineStageFlags, VkPipelineStageFlags, VkDependencyFlags,
                                 std::uint32_t, const VkMemoryBarrier*, std::uint32_t, const VkBufferMemoryBarrier*,
                                 std::uint32_t, const VkImageMemoryBarrier*) { ++recorded.barriers; };
    vk.vkCmdCopyBuffer = [](VkCommandBuffer, VkBuffer, VkBuffer, std::uint32_t, const VkBufferCopy*) {
        ++recorded.copies;
    };
    vk.vkCmdFillBuffer = [](VkCommandBuffer, VkBuffer, VkDeviceSize, VkDeviceSize, std::uint32_t) {
        ++recorded.copies;
    };
    vk.vkCmdUpdateBuffer = [](VkCommandBuffer, VkBuffer, VkDeviceSize, VkDeviceSize, const void*) {
        ++recorded.copies;
    };
}

void record_nothing(VulkanTable& vk) {
    mute_commands(vk);
    count_commands(vk);
    vk.vkCreateCommandPool = [](VkDevice, const VkCommandPoolCreateInfo*, const VkAllocationCallbacks*,
                                VkCommandPool* pool) { return make(*pool); };
    vk.vkDestroyCommandPool = [](VkDevice, VkCommandPool pool, const VkAllocationCallbacks*) { release(pool); };
    vk.vkAllocateCommandBuffers = [](VkDevice, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* buffers) {
        std::fill_n(buffers, info->commandBufferCount, VkCommandBuffer{});
        return VK_SUCCESS;
    };
    vk.vkBeginCommandBuffer = [](VkCommandBuffer, const VkCommandBufferBeginInfo*) { return VK_SUCCESS; };
    vk.vkEndCommandBuffer = [](VkCommandBuffer) { return VK_SUCCESS; };
    vk.vkCreateQueryPool = [](VkDevice, const VkQueryPoolCreateInfo*, const VkAllocationCallbacks*, VkQueryPool* pool) {
        return make(*pool);
    };
    vk.vkDestroyQueryPool = [](VkDevice, VkQueryPool pool, const VkAllocationCallbacks*) { release(pool); };
    vk.vkGetQueryPoolResults = [](VkDevice, VkQueryPool, std::uint32_t, std::uint32_t, std::size_t, void*, VkDeviceSize,
                                  VkQueryResultFlags) { return VK_SUCCESS; };
}

void pass_at_once(VulkanTable& vk) {
    vk.vkQueueSubmit = [](VkQueue, std::uint32_t, const VkSubmitInfo*, VkFence) { return VK_SUCCESS; };
    vk.vkCreateSemaphore = [](VkDevice, const VkSemaphoreCreateInfo*, const VkAllocationCallbacks*,
                              VkSemaphore* semaphore) { return make(*semaphore); };
    vk.vkDestroySemaphore = [](VkDevice, VkSemaphore semaphore, const VkAllocationCallbacks*) { release(semaphore); };
    vk.vkWaitSemaphores = [](VkDevice, const VkSemaphoreWaitInfo*, std::uint64_t) { return VK_SUCCESS; };
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
    vk.vkCreateAccelerationStructureKHR = [](VkDevice, const VkAccelerationStructureCreateInfoKHR*,
                                             const VkAllocationCallbacks*,
                                             VkAccelerationStructureKHR* structure) { return make(*structure); };
    vk.vkDestroyAccelerationStructureKHR = [](VkDevice, VkAccelerationStructureKHR structure,
                                              const VkAllocationCallbacks*) { release(structure); };
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
