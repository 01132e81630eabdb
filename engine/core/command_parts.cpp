// The command buffers of Commands: their start, submission and timing.
#include <algorithm>

#include "engine/core/commands.h"
#include "engine/core/error.h"
#include "engine/core/stopwatch.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

// Returns null if the queue has none.
VkQueryPool new_timestamps(Context& context, VkCommandBuffer commands, std::uint32_t count) {
    if (context.state().timestamp_period_ns() == 0) return VK_NULL_HANDLE;
    VkQueryPoolCreateInfo info = OfType{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = count;
    const VulkanTable& vk = context.state().vk();
    const VkQueryPool pool = created(vk.vkCreateQueryPool, context.device(), info, "create a timestamp pool");
    vk.vkCmdResetQueryPool(commands, pool, 0, count);
    return pool;
}

VkCommandBuffer begun_buffer(Context& context, VkCommandPool pool, const std::string& name) {
    const VulkanTable& vk = context.state().vk();
    VkCommandBufferAllocateInfo allocate = OfType{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer handle = VK_NULL_HANDLE;
    vk_check(vk.vkAllocateCommandBuffers(context.device(), &allocate, &handle), "allocate a command buffer");
    context.state().set_name(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<std::uint64_t>(handle), name);
    VkCommandBufferBeginInfo info = OfType{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vk_check(vk.vkBeginCommandBuffer(handle, &info), "begin a command buffer");
    return handle;
}

double seconds_of(std::span<const PassTiming> passes) {
    double ms = 0;
    for (const PassTiming& pass : passes) ms += pass.ms;
    return ms * 1e-3;
}

}  // namespace

Commands::Commands(Context& context, const std::string& name) : state_(new State{.context = context, .name = name}) {
    context.state().check_alive();
    state_->begin_part();
}

Commands::Commands(Context& context, const std::string& name, const CallerCommands& caller)
    : state_(
          new State{.context = context,
                    .name = name,
                    .is_of_caller = true,
                    .consumer_stages = caller.consumer_stages,
                    .consumer_access = caller.consumer_access | VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                    .done = caller.done}) {
    context.state().check_alive();
    if (!caller.handle) fail("commands '", state_->name, "': the caller's command buffer is null");
    if (!caller.done.semaphore || !caller.done.value)
        fail("commands '", state_->name,
             "': the caller must say with which semaphore and value (not 0) its commands are done");
    const VkQueryPool queries = new_timestamps(context, caller.handle, 2 * State::max_timed_passes);
    state_->parts.push_back({VK_NULL_HANDLE, caller.handle, queries});
    context.announce(caller.done);
    VkMemoryBarrier barrier = OfType{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    barrier.srcAccessMask = caller.producer_access;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    context.state().vk().vkCmdPipelineBarrier(caller.handle, caller.producer_stages | context.state().stages(),
                                              context.state().stages(), 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

Commands::~Commands() {
    if (state_->promised.value) state_->context.state().give_up(state_->promised.value);
    state_->retire_parts();
}

SyncPoint Commands::promise() {
    if (state_->is_of_caller) return state_->done;
    if (state_->is_ended) fail("commands '", state_->name, "': they are submitted; nothing more can count on them");
    if (!state_->promised.value) state_->promised = state_->context.state().promise();
    return state_->promised;
}

void Commands::State::begin_part() {
    VkCommandPoolCreateInfo info = OfType{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    info.queueFamilyIndex = context.queue_family();
    const VulkanTable& vk = context.state().vk();
    const VkCommandPool pool = created(vk.vkCreateCommandPool, context.device(), info, "create a command pool");
    try {
        const VkCommandBuffer handle = begun_buffer(context, pool, name);
        parts.push_back({pool, handle, new_timestamps(context, handle, 2 * max_timed_passes)});
    } catch (...) {
        vk.vkDestroyCommandPool(context.device(), pool, nullptr);
        throw;
    }
    groups = 0;
    // Earlier submissions on this queue are ordered before, but their writes need to be made visible.
    end_pass();
}

bool Commands::State::is_part_full() const {
    return !is_of_caller && groups > most_groups(context.state().tuning().most_submission_seconds);
}

void Commands::State::retire_parts() {
    for (const Part& part : parts)
        context.state().retire(
            [&vk = context.state().vk(), device = context.device(), pool = part.pool, queries = part.queries] {
                vk.vkDestroyCommandPool(device, pool, nullptr);
                vk.vkDestroyQueryPool(device, queries, nullptr);
            });
    parts.clear();
}

SyncPoint Commands::submit() {
    if (state_->is_of_caller) fail("commands '", state_->name, "': they are the caller's to submit");
    if (state_->is_ended) fail("commands '", state_->name, "': submitted twice");
    if (state_->in_pass) fail("commands '", state_->name, "': submitted within a pass");
    if (state_->promised.value && !state_->context.state().is_due(state_->promised.value))
        fail("commands '", state_->name, "': others, into which a sync was recorded before, must be submitted first");
    state_->is_ended = true;
    std::vector<Submission> submissions;
    for (const State::Part& part : state_->parts) {
        vk_check(state_->context.state().vk().vkEndCommandBuffer(part.handle), "end a command buffer");
        submissions.push_back({part.handle, part.passes});
    }
    state_->done = state_->context.state().submit(state_->name, std::move(submissions), state_->promised.value);
    state_->promised = {};
    state_->retained.clear();  // retired behind the submission just made
    return state_->done;
}

double Commands::submit_and_wait() {
    const Stopwatch start;
    state_->context.wait(submit());
    if (state_->parts.front().queries) return seconds_of(state_->timings_of_parts());
    return start.seconds();
}

double Commands::submit_part() {
    const double seconds = submit_and_wait();
    std::ranges::copy(state_->timings_of_parts(), std::back_inserter(state_->earlier));
    state_->retire_parts();
    state_->begin_part();
    state_->is_ended = false;
    return seconds;
}

void Commands::State::write_timestamp(std::size_t index) const {
    if (const Part& part = parts.back(); part.queries && index < 2 * max_timed_passes)
        context.state().vk().vkCmdWriteTimestamp(part.handle, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, part.queries,
                                                 static_cast<std::uint32_t>(index));
}

std::vector<PassTiming> Commands::timings() const {
    state_->context.wait(state_->done);
    std::vector<PassTiming> timings = state_->earlier;
    std::ranges::copy(state_->timings_of_parts(), std::back_inserter(timings));
    return timings;
}

std::vector<PassTiming> Commands::State::timings_of_parts() const {
    const Context::State& state = context.state();
    std::vector<PassTiming> timings;
    for (const Part& part : parts) {
        const std::uint32_t count = std::min(static_cast<std::uint32_t>(part.passes.size()), max_timed_passes);
        if (!part.queries || count == 0) continue;
        std::vector<std::uint64_t> stamps(2 * count);
        state.check(state.vk().vkGetQueryPoolResults(context.device(), part.queries, 0, 2 * count, stamps.size() * 8,
                                                     stamps.data(), 8, VK_QUERY_RESULT_64_BIT),
                    "read timestamps");
        for (std::uint32_t i = 0; i < count; ++i) {
            const double ticks = static_cast<double>(stamps[2 * i + 1] - stamps[2 * i]);
            timings.push_back({part.passes[i].name, ticks * state.timestamp_period_ns() * 1e-6});
        }
    }
    return timings;
}

}  // namespace twinray
