// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/frame_commands.h"

namespace twinray::embed_renderer {

FrameCommands::FrameCommands(const Device& device) : device_(device) {
    try {
        VkCommandPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool.queueFamilyIndex = device.queue_family();
        require(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "create a command pool");
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = pool_;
        allocate.commandBufferCount = 1;
        require(vkAllocateCommandBuffers(device.handle(), &allocate, &commands_), "allocate a command buffer");
        VkSemaphoreTypeCreateInfo type{};
        type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
        type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        semaphore.pNext = &type;
        require(vkCreateSemaphore(device.handle(), &semaphore, nullptr, &timeline_), "create the timeline");
    } catch (...) {
        destroy();
        throw;
    }
}

FrameCommands::~FrameCommands() { destroy(); }

void FrameCommands::destroy() {
    vkDestroySemaphore(device_.handle(), timeline_, nullptr);
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

VkCommandBuffer FrameCommands::begin() {
    require(vkResetCommandPool(device_.handle(), pool_, 0), "reset the command pool");
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    require(vkBeginCommandBuffer(commands_, &begin), "begin a command buffer");
    return commands_;
}

void FrameCommands::submit() {
    require(vkEndCommandBuffer(commands_), "end a command buffer");
    const SyncPoint signalled = done();
    VkTimelineSemaphoreSubmitInfo timeline{};
    timeline.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
    timeline.signalSemaphoreValueCount = 1;
    timeline.pSignalSemaphoreValues = &signalled.value;
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.pNext = &timeline;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands_;
    info.signalSemaphoreCount = 1;
    info.pSignalSemaphores = &signalled.semaphore;
    require(vkQueueSubmit(device_.queue(), 1, &info, VK_NULL_HANDLE), "submit a frame");
    submitted_ = signalled.value;
}

void FrameCommands::wait() const {
    VkSemaphoreWaitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline_;
    info.pValues = &submitted_;
    require(vkWaitSemaphores(device_.handle(), &info, UINT64_MAX), "wait for a frame");
}

}  // namespace twinray::embed_renderer
