// SPDX-License-Identifier: MIT
#include "engine/core/commands.h"

#include <utility>

#include "engine/core/error.h"

namespace twinray {
namespace {

VkCommandPool new_pool(Context& context) {
    VkCommandPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    info.queueFamilyIndex = context.queue_family();
    VkCommandPool pool = VK_NULL_HANDLE;
    vk_check(context.vk().vkCreateCommandPool(context.device(), &info, nullptr, &pool), "create a command pool");
    return pool;
}

VkQueryPool new_timestamps(Context& context, std::uint32_t count) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = count;
    VkQueryPool pool = VK_NULL_HANDLE;
    vk_check(context.vk().vkCreateQueryPool(context.device(), &info, nullptr, &pool), "create a timestamp pool");
    return pool;
}

void check_range(const Buffer& buffer, std::uint64_t offset, std::uint64_t bytes, const char* action) {
    if (offset > buffer.bytes() || bytes > buffer.bytes() - offset)
        fail("buffer '", buffer.name(), "': ", action, " of ", bytes, " bytes at ", offset, " exceeds its ",
             buffer.bytes(), " bytes");
}

}  // namespace

Commands::Commands(Context& context, const std::string& name) : context_(context), name_(name) {
    context.check_alive();
    const VulkanFunctions& vk = context.vk();
    try {
        pool_ = new_pool(context);
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = pool_;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        vk_check(vk.vkAllocateCommandBuffers(context.device(), &allocate, &handle_), "allocate a command buffer");
        context.set_name(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<std::uint64_t>(handle_), name_);
        VkCommandBufferBeginInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        vk_check(vk.vkBeginCommandBuffer(handle_, &info), "begin a command buffer");
        begin();
    } catch (...) {
        if (pool_) vk.vkDestroyCommandPool(context.device(), pool_, nullptr);
        throw;
    }
    // Earlier submissions on this queue are ordered before, but their writes need to be made visible.
    end_pass();
}

Commands::Commands(Context& context, const std::string& name, const CallerCommands& caller)
    : context_(context),
      name_(name),
      handle_(caller.handle),
      consumer_stages_(caller.consumer_stages),
      consumer_access_(caller.consumer_access | VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT),
      done_(caller.done) {
    context.check_alive();
    if (!caller.handle) fail("commands '", name_, "': the caller's command buffer is null");
    if (!caller.done.semaphore || !caller.done.value)
        fail("commands '", name_,
             "': the caller must say with which semaphore and value (not 0) its commands are done");
    begin();
    context.announce(caller.done);
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = caller.producer_access;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    context.vk().vkCmdPipelineBarrier(handle_, caller.producer_stages | context.stages(), context.stages(), 0, 1,
                                      &barrier, 0, nullptr, 0, nullptr);
}

void Commands::begin() {
    if (context_.timestamp_period_ns() == 0) return;
    queries_ = new_timestamps(context_, 2 * max_timed_passes_);
    context_.vk().vkCmdResetQueryPool(handle_, queries_, 0, 2 * max_timed_passes_);
}

Commands::~Commands() {
    context_.retire([&vk = context_.vk(), device = context_.device(), pool = pool_, queries = queries_] {
        vk.vkDestroyCommandPool(device, pool, nullptr);
        vk.vkDestroyQueryPool(device, queries, nullptr);
    });
}

Commands::Pass::Pass(Commands& commands, const std::string& name) : commands_(commands) { commands_.begin_pass(name); }

Commands::Pass::~Pass() {
    Commands& c = commands_;
    c.write_timestamp(2 * static_cast<std::uint32_t>(c.passes_.size()) - 1);
    c.end_pass();
    if (c.context_.vk().vkCmdEndDebugUtilsLabelEXT) c.context_.vk().vkCmdEndDebugUtilsLabelEXT(c.handle_);
}

void Commands::begin_pass(const std::string& name) {
    if (in_pass_) fail("commands '", name_, "': pass '", name, "' starts inside pass '", passes_.back().name, "'");
    if (is_ended_) fail("commands '", name_, "': pass '", name, "' recorded after submit");
    in_pass_ = true;
    passes_.push_back({name});
    if (context_.vk().vkCmdBeginDebugUtilsLabelEXT) {
        VkDebugUtilsLabelEXT label{};
        label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
        label.pLabelName = name.c_str();
        context_.vk().vkCmdBeginDebugUtilsLabelEXT(handle_, &label);
    }
    write_timestamp(2 * static_cast<std::uint32_t>(passes_.size()) - 2);
}

void Commands::write_timestamp(std::uint32_t index) const {
    if (queries_ && index < 2 * max_timed_passes_)
        context_.vk().vkCmdWriteTimestamp(handle_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, index);
}

void Commands::end_pass() {
    barrier();
    in_pass_ = false;
}

void Commands::barrier() {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = consumer_access_;
    context_.vk().vkCmdPipelineBarrier(handle_, context_.stages(), context_.stages() | consumer_stages_, 0, 1, &barrier,
                                       0, nullptr, 0, nullptr);
}

void Commands::upload(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data) {
    const Piece piece{offset, data};
    upload_pieces(target, std::span(&piece, 1));
}

void Commands::write_bytes(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data) {
    check_range(target, offset, data.size(), "write");
    context_.vk().vkCmdUpdateBuffer(handle_, target.handle(), offset, data.size(), data.data());
}

void Commands::upload_pieces(const Buffer& target, std::span<const Piece> pieces) {
    std::vector<VkBufferCopy> regions;
    std::uint64_t bytes = 0;
    for (const Piece& piece : pieces) {
        if (piece.data.empty()) continue;
        check_range(target, piece.offset, piece.data.size(), "upload");
        regions.push_back({bytes, piece.offset, piece.data.size()});
        bytes += piece.data.size();
    }
    if (regions.empty()) return;
    Buffer staging(context_, {.name = "staging for " + target.name(), .bytes = bytes, .memory = Memory::upload});
    std::byte* next = staging.mapped();
    for (const Piece& piece : pieces) {
        if (piece.data.empty()) continue;
        std::memcpy(next, piece.data.data(), piece.data.size());
        next += piece.data.size();
    }
    context_.vk().vkCmdCopyBuffer(handle_, staging.handle(), target.handle(),
                                  static_cast<std::uint32_t>(regions.size()), regions.data());
    keep(std::move(staging));
}

void Commands::copy(const Buffer& from, std::uint64_t from_offset, const Buffer& to, std::uint64_t to_offset,
                    std::uint64_t bytes) {
    if (bytes == 0) return;
    check_range(from, from_offset, bytes, "copy");
    check_range(to, to_offset, bytes, "copy");
    const VkBufferCopy region{from_offset, to_offset, bytes};
    context_.vk().vkCmdCopyBuffer(handle_, from.handle(), to.handle(), 1, &region);
}

void Commands::fill(const Buffer& target, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word) {
    if (bytes == 0) return;
    check_range(target, offset, bytes, "fill");
    context_.vk().vkCmdFillBuffer(handle_, target.handle(), offset, bytes, word);
}

SyncPoint Commands::submit() {
    if (is_of_caller()) fail("commands '", name_, "': they are the caller's to submit");
    if (is_ended_) fail("commands '", name_, "': submitted twice");
    is_ended_ = true;
    vk_check(context_.vk().vkEndCommandBuffer(handle_), "end a command buffer");
    done_ = context_.submit(handle_, name_, passes_);
    kept_.clear();  // retired behind the submission just made
    return done_;
}

std::vector<PassTiming> Commands::timings() const {
    context_.wait(done_);
    if (!queries_) return {};
    const std::uint32_t count = std::min(static_cast<std::uint32_t>(passes_.size()), max_timed_passes_);
    std::vector<std::uint64_t> stamps(2 * count);
    if (count)
        context_.check(context_.vk().vkGetQueryPoolResults(context_.device(), queries_, 0, 2 * count, stamps.size() * 8,
                                                           stamps.data(), 8, VK_QUERY_RESULT_64_BIT),
                       "read timestamps");
    std::vector<PassTiming> timings;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double ticks = static_cast<double>(stamps[2 * i + 1] - stamps[2 * i]);
        timings.push_back({passes_[i].name, ticks * context_.timestamp_period_ns() * 1e-6});
    }
    return timings;
}

std::vector<std::byte> download_bytes(Context& context, const Buffer& buffer, std::uint64_t offset,
                                      std::uint64_t bytes) {
    if (bytes == 0) return {};
    check_range(buffer, offset, bytes, "download");
    Buffer readback(context, {.name = "readback of " + buffer.name(), .bytes = bytes, .memory = Memory::readback});
    Commands commands(context, "download");
    {
        const auto pass = commands.pass("download");
        commands.copy(buffer, offset, readback, 0, bytes);
    }
    context.wait(commands.submit());
    return {readback.mapped(), readback.mapped() + bytes};
}

}  // namespace twinray
