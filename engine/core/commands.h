// SPDX-License-Identifier: MIT
// Command buffers: passes of dispatches and copies, their submission and their times.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "engine/core/buffer.h"

namespace twinray {

// GPU time of one named pass.
struct PassTiming {
    std::string name;
    double ms = 0;
};

// A command buffer of the caller: begun, outside a render pass, for a queue of Context::queue_family(), submitted once.
struct CallerCommands {
    VkCommandBuffer handle = VK_NULL_HANDLE;
    // A value of a timeline semaphore of the caller that the submission will signal. Until it is reached, twinray keeps
    // what the commands use; so it must be reached, from the host or by a later value, even if they are given up.
    SyncPoint done;
    // The caller's earlier work whose writes twinray must see, and the later work that uses what twinray writes.
    VkPipelineStageFlags producer_stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkAccessFlags producer_access = VK_ACCESS_MEMORY_WRITE_BIT;
    VkPipelineStageFlags consumer_stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkAccessFlags consumer_access = VK_ACCESS_MEMORY_READ_BIT;
};

// A straight line of named passes. The end of a pass is a global memory barrier, so each pass sees all that earlier
// passes wrote; dispatches inside one pass must not depend on each other. Own commands may become several command
// buffers, cut between passes, so that none keeps the device busy for too long (engine/core/pace.h).
class Commands {
  public:
    // Own commands, submitted by submit().
    Commands(Context& context, const std::string& name);
    // Records into the caller's. Throws Error unless caller.handle and caller.done are set.
    Commands(Context& context, const std::string& name, const CallerCommands& caller);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    // A scope: everything recorded while it lives belongs to it.
    class Pass {
      public:
        Pass(Commands& commands, const std::string& name);
        ~Pass();
        Pass(const Pass&) = delete;
        Pass& operator=(const Pass&) = delete;

      private:
        Commands& commands_;
    };
    [[nodiscard]] Pass pass(const std::string& name) { return Pass(*this, name); }
    bool in_pass() const { return in_pass_; }
    // Within a pass: what follows sees what went before, as from one pass to the next.
    void barrier();

    // Copies into `target` through a staging buffer that lives until the GPU has read it.
    void upload(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data);
    template <class T>
    void upload(const Buffer& target, std::span<const T> data, std::uint64_t offset = 0) {
        upload(target, offset, std::as_bytes(data));
    }
    // A value of at most 64 KiB, without staging.
    template <class T>
    void write(const Buffer& target, const T& value, std::uint64_t offset = 0) {
        write_bytes(target, offset, std::as_bytes(std::span(&value, 1)));
    }
    // Many pieces through one staging buffer and one copy.
    struct Piece {
        std::uint64_t offset;  // in the target
        std::span<const std::byte> data;
    };
    void upload_pieces(const Buffer& target, std::span<const Piece> pieces);
    void copy(const Buffer& from, std::uint64_t from_offset, const Buffer& to, std::uint64_t to_offset,
              std::uint64_t bytes);
    // bytes must be a multiple of 4.
    void fill(const Buffer& target, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word);

    // Tells of a dispatch in the present pass.
    void count_groups(std::uint64_t groups) { parts_.back().passes.back().groups += groups, count_work(groups); }
    // The same of work of the driver that is as large as so many groups.
    void count_work(std::uint64_t groups) { groups_ += groups; }

    // Takes ownership until the GPU has finished these commands.
    void keep(Buffer&& temporary) { kept_.push_back(std::move(temporary)); }

    // Once, at the end, even if it fails. The object may then be destroyed at any time. Throws Error for commands of
    // the caller.
    SyncPoint submit();
    // The same, and waits. How many seconds the GPU was busy; where the queue has no timestamps, the host waited.
    double submit_and_wait();
    // The same with what is recorded so far: more may follow. Not within a pass.
    double submit_part();
    bool is_of_caller() const { return is_of_caller_; }
    // When these commands are done: CallerCommands::done, or what submit() returned.
    SyncPoint done() const { return done_; }

    // After the submission: waits for the GPU; one entry per pass in recording order, none where the queue has no
    // timestamps.
    std::vector<PassTiming> timings() const;

    Context& context() const { return context_; }
    VkCommandBuffer handle() const { return parts_.back().handle; }  // where the next pass is recorded, until it ends

  private:
    struct Part {
        VkCommandPool pool = VK_NULL_HANDLE;  // null: the caller's
        VkCommandBuffer handle = VK_NULL_HANDLE;
        VkQueryPool queries = VK_NULL_HANDLE;  // null: the queue has no timestamps
        std::vector<PassWork> passes = {};
    };
    void write_bytes(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data);
    void begin_part();
    void begin_pass(const std::string& name);
    void end_pass();
    void write_timestamp(std::size_t index) const;
    bool is_part_full() const;
    void retire_parts();
    std::vector<PassTiming> timings_of(const Part& part) const;
    std::vector<PassTiming> timings_of_parts() const;

    static constexpr std::uint32_t max_timed_passes_ = 512;  // of a part; passes beyond it are recorded but not timed
    Context& context_;
    std::string name_;
    bool is_of_caller_ = false;
    std::vector<Part> parts_;          // of which the last is recorded into; none where beginning another failed
    std::vector<PassTiming> earlier_;  // of parts that were submitted before these
    std::uint64_t groups_ = 0;         // of the last part
    // What follows the commands besides twinray itself.
    VkPipelineStageFlags consumer_stages_ = VK_PIPELINE_STAGE_HOST_BIT;
    VkAccessFlags consumer_access_ = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    std::vector<Buffer> kept_;
    bool in_pass_ = false;
    bool is_ended_ = false;
    SyncPoint done_;
};

// Copies a range back to the host; submits and waits.
std::vector<std::byte> download_bytes(Context& context, const Buffer& buffer, std::uint64_t offset,
                                      std::uint64_t bytes);

template <class T>
std::vector<T> download(Context& context, const Buffer& buffer, std::uint64_t count, std::uint64_t byte_offset = 0) {
    const std::vector<std::byte> bytes = download_bytes(context, buffer, byte_offset, count * sizeof(T));
    std::vector<T> values(count);
    if (count) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

}  // namespace twinray
