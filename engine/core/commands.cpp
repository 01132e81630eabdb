#include "engine/core/commands.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/interruption.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

void check_range(const Buffer& buffer, std::uint64_t offset, std::uint64_t bytes, const char* action) {
    if (offset > buffer.bytes() || bytes > buffer.bytes() - offset)
        fail("buffer '", buffer.name(), "': ", action, " of ", bytes, " bytes at ", offset, " exceeds its ",
             buffer.bytes(), " bytes");
}

constexpr double aimed_share = 0.25;  // of the most seconds, which a submission aims at
constexpr double most_growth = 4;
constexpr double most_interruptible_seconds = 2;
constexpr std::uint64_t fewest_items = 64;
constexpr double slowest_items_per_second = 1 << 17, slowest_groups_per_second = 1 << 17;

std::uint64_t whole_groups(double items) {
    constexpr double most = 0x1p63;
    return std::max(static_cast<std::uint64_t>(std::min(items, most)) / fewest_items, std::uint64_t{1}) * fewest_items;
}

double most_seconds(double of_device, bool is_interruptible) {
    return is_interruptible && of_device == 0 ? most_interruptible_seconds : of_device;
}

}  // namespace

Commands::Pass::Pass(Commands& commands, const std::string& name) : commands_(commands) {
    commands.state_->begin_pass(name);
}

Commands::Pass::~Pass() {
    State& state = *commands_.state_;
    state.write_timestamp(2 * state.parts.back().passes.size() - 1);
    state.end_pass();
    const VulkanTable& vk = state.context.state().vk();
    if (vk.vkCmdEndDebugUtilsLabelEXT) vk.vkCmdEndDebugUtilsLabelEXT(state.handle());
}

void Commands::State::begin_pass(const std::string& pass) {
    if (in_pass)
        fail("commands '", name, "': pass '", pass, "' starts inside pass '", parts.back().passes.back().name, "'");
    if (is_ended) fail("commands '", name, "': pass '", pass, "' recorded after submit");
    if (is_part_full()) begin_part();
    in_pass = true;
    parts.back().passes.push_back({pass});
    if (context.state().vk().vkCmdBeginDebugUtilsLabelEXT) {
        VkDebugUtilsLabelEXT label = OfType{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
        label.pLabelName = pass.c_str();
        context.state().vk().vkCmdBeginDebugUtilsLabelEXT(handle(), &label);
    }
    write_timestamp(2 * parts.back().passes.size() - 2);
}

void Commands::State::end_pass() {
    barrier();
    in_pass = false;
}

void Commands::State::barrier() {
    VkMemoryBarrier barrier = OfType{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = consumer_access;
    context.state().vk().vkCmdPipelineBarrier(handle(), context.state().stages(),
                                              context.state().stages() | consumer_stages, 0, 1, &barrier, 0, nullptr, 0,
                                              nullptr);
}

void Commands::barrier() { state_->barrier(); }
bool Commands::in_pass() const { return state_->in_pass; }
bool Commands::is_of_caller() const { return state_->is_of_caller; }
SyncPoint Commands::done() const { return state_->done; }
Context& Commands::context() const { return state_->context; }
VkCommandBuffer Commands::handle() const { return state_->handle(); }
void Commands::retain(Buffer&& temporary) { state_->retained.push_back(std::move(temporary)); }
void Commands::count_work(std::uint64_t groups) { state_->groups += groups; }

void Commands::count_groups(std::uint64_t groups) {
    state_->parts.back().passes.back().groups += groups;
    count_work(groups);
}

void Commands::upload(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data) {
    const Region region{offset, data};
    upload_regions(target, std::span(&region, 1));
}

void Commands::write_bytes(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data) {
    check_range(target, offset, data.size(), "write");
    state_->context.state().vk().vkCmdUpdateBuffer(handle(), target.handle(), offset, data.size(), data.data());
}

void Commands::upload_regions(const Buffer& target, std::span<const Region> regions) {
    std::vector<VkBufferCopy> copies;
    std::uint64_t bytes = 0;
    for (const Region& region : regions) {
        if (region.data.empty()) continue;
        check_range(target, region.offset, region.data.size(), "upload");
        copies.push_back({bytes, region.offset, region.data.size()});
        bytes += region.data.size();
    }
    if (copies.empty()) return;
    Buffer staging(state_->context, {.name = "staging for " + target.name(), .bytes = bytes, .memory = Memory::upload});
    std::byte* next = staging.mapped();
    for (const Region& region : regions) {
        if (region.data.empty()) continue;
        std::memcpy(next, region.data.data(), region.data.size());
        next += region.data.size();
    }
    state_->context.state().vk().vkCmdCopyBuffer(handle(), staging.handle(), target.handle(),
                                                 static_cast<std::uint32_t>(copies.size()), copies.data());
    retain(std::move(staging));
}

void Commands::copy(const Buffer& from, std::uint64_t from_offset, const Buffer& to, std::uint64_t to_offset,
                    std::uint64_t bytes) {
    if (bytes == 0) return;
    check_range(from, from_offset, bytes, "copy");
    check_range(to, to_offset, bytes, "copy");
    const VkBufferCopy region{from_offset, to_offset, bytes};
    state_->context.state().vk().vkCmdCopyBuffer(handle(), from.handle(), to.handle(), 1, &region);
}

void Commands::fill(const Buffer& target, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word) {
    if (bytes == 0) return;
    check_range(target, offset, bytes, "fill");
    state_->context.state().vk().vkCmdFillBuffer(handle(), target.handle(), offset, bytes, word);
}

void download_bytes(Context& context, const Buffer& buffer, std::uint64_t offset, std::span<std::byte> into) {
    if (into.empty()) return;
    check_range(buffer, offset, into.size(), "download");
    const Buffer readback(context,
                          {.name = "readback of " + buffer.name(), .bytes = into.size(), .memory = Memory::readback});
    Commands commands(context, "download");
    {
        const auto pass = commands.pass("download");
        commands.copy(buffer, offset, readback, 0, into.size());
    }
    context.wait(commands.submit());
    std::memcpy(into.data(), readback.mapped(), into.size());
}

std::uint64_t first_items(double most_seconds) {
    return whole_groups(slowest_items_per_second * most_seconds * aimed_share);
}

std::uint64_t next_items(std::uint64_t allowed, const MeasuredWork& last, double most_seconds) {
    const double aim = most_seconds * aimed_share;
    if (last.items < allowed && last.seconds <= aim) return allowed;
    const auto items = static_cast<double>(last.items);
    // The queue's clock may be too coarse for it.
    return whole_groups(last.seconds * most_growth > aim ? items * aim / last.seconds : items * most_growth);
}

std::uint64_t most_groups(double most_seconds) {
    if (most_seconds == 0) return UINT64_MAX;
    return static_cast<std::uint64_t>(slowest_groups_per_second * most_seconds * aimed_share);
}

// A caller who may want to end the work does not want to wait for submitted work either.
Pace::Pace(const Context& context)
    : most_seconds_(most_seconds(context.state().tuning().most_submission_seconds, is_interruptible())),
      allowed_(first_items(most_seconds_)) {}

std::uint64_t Pace::next(std::uint64_t left) const { return most_seconds_ == 0 ? left : std::min(left, allowed_); }

void Pace::took(double seconds) { allowed_ = next_items(allowed_, {pending_, seconds}, most_seconds_); }

void Pace::finish(Commands& commands) {
    const double seconds = commands.submit_and_wait();
    if (pending_ > 0) took(seconds);
    pending_ = 0;
}

}  // namespace twinray
