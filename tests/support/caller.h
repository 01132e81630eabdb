// A host with a command buffer and a timeline of its own on a context's device.
#pragma once

#include "engine/core/commands.h"
#include "engine/core/error.h"
#include "engine/core/vulkan.h"

namespace twinray::test {

class Caller {
  public:
    explicit Caller(Context& context) : context_(context), vk_(context.state().vk()) {
        VkSemaphoreTypeCreateInfo type{};
        type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
        type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        semaphore.pNext = &type;
        vk_check(vk_.vkCreateSemaphore(context.device(), &semaphore, nullptr, &timeline_), "create a semaphore");
        VkCommandPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool.queueFamilyIndex = context.queue_family();
        vk_check(vk_.vkCreateCommandPool(context.device(), &pool, nullptr, &pool_), "create a command pool");
        vk_.vkGetDeviceQueue(context.device(), context.queue_family(), 0, &queue_);
    }
    ~Caller() {
        context_.wait_for_gpu();
        vk_.vkDestroyCommandPool(context_.device(), pool_, nullptr);
        vk_.vkDestroySemaphore(context_.device(), timeline_, nullptr);
    }
    Caller(const Caller&) = delete;
    Caller& operator=(const Caller&) = delete;

    // Returns a begun command buffer, to be given to submit().
    CallerCommands begin() {
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = pool_;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        CallerCommands commands;
        vk_check(vk_.vkAllocateCommandBuffers(context_.device(), &allocate, &commands.handle), "allocate");
        VkCommandBufferBeginInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        vk_check(vk_.vkBeginCommandBuffer(commands.handle, &info), "begin");
        commands.done = {timeline_, ++value_};
        return commands;
    }
    // Returns one that `record` has filled.
    template <class Record>
    CallerCommands record(const std::string& name, const Record& record) {
        const CallerCommands buffer = begin();
        Commands commands(context_, name, buffer);
        record(commands);
        return buffer;
    }
    void submit(const CallerCommands& commands) {
        vk_check(vk_.vkEndCommandBuffer(commands.handle), "end");
        VkTimelineSemaphoreSubmitInfo timeline{};
        timeline.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
        timeline.signalSemaphoreValueCount = 1;
        timeline.pSignalSemaphoreValues = &commands.done.value;
        VkSubmitInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        info.pNext = &timeline;
        info.commandBufferCount = 1;
        info.pCommandBuffers = &commands.handle;
        info.signalSemaphoreCount = 1;
        info.pSignalSemaphores = &timeline_;
        vk_check(vk_.vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE), "submit");
    }
    // Signals from the host, instead of submitting the last buffer that was begun.
    void signal() {
        VkSemaphoreSignalInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO;
        info.semaphore = timeline_;
        info.value = value_;
        const auto signal =
            reinterpret_cast<PFN_vkSignalSemaphore>(vk_.vkGetDeviceProcAddr(context_.device(), "vkSignalSemaphore"));
        vk_check(signal(context_.device(), &info), "signal");
    }

  private:
    Context& context_;
    const VulkanTable& vk_;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::uint64_t value_ = 0;
};

}  // namespace twinray::test
