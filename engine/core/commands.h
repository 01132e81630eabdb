// The command buffers that Commands consists of, and the limits of the work of a submission: drivers reset a GPU that
// is busy with one for too long.
#pragma once

#include <twinray/commands.h>

#include "engine/core/context.h"
#include "twinray/glsl/cpp.h"

namespace twinray {

// The alignment of data that is read a whole line at a time, on all CPUs that matter and most GPUs.
inline constexpr std::uint64_t cache_line_bytes = 64;

struct Commands::State {
    struct Part {
        VkCommandPool pool = VK_NULL_HANDLE;  // null: the caller's
        VkCommandBuffer handle = VK_NULL_HANDLE;
        VkQueryPool queries = VK_NULL_HANDLE;  // null: the queue has no timestamps
        std::vector<PassWork> passes = {};
    };
    void begin_part();
    void begin_pass(const std::string& pass);
    void end_pass();
    void barrier();
    void write_timestamp(std::size_t index) const;
    bool is_part_full() const;
    void retire_parts();
    std::vector<PassTiming> timings_of_parts() const;
    VkCommandBuffer handle() const { return parts.back().handle; }

    static constexpr std::uint32_t max_timed_passes = 512;  // of a part; passes beyond it are recorded but not timed
    Context& context;
    std::string name;
    bool is_of_caller = false;
    // The work that follows the commands besides twinray itself.
    VkPipelineStageFlags consumer_stages = VK_PIPELINE_STAGE_HOST_BIT;
    VkAccessFlags consumer_access = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    SyncPoint done = {};
    SyncPoint promised = {};               // another point that own commands will reach, if other work relies on it
    std::vector<Part> parts = {};          // the last is recorded into; none if beginning another failed
    std::vector<PassTiming> earlier = {};  // of parts that were submitted before these
    std::uint64_t groups = 0;              // of the last part
    std::vector<Buffer> retained = {};
    bool in_pass = false;
    bool is_ended = false;
};

// A number of items of work, each a ray, a point or a pair of boxes, and how long the device was busy with them.
struct MeasuredWork {
    std::uint64_t items = 0;
    double seconds = 0;
};

// Returns the number of items of a submission before any is measured: a quarter of `most_seconds` if a device does 2^17
// items in a second. It is a multiple of 64, like all counts of items here, and at least 64.
std::uint64_t first_items(double most_seconds);

// Returns the number of items after `last`, which could have had `allowed`: as many as take a quarter of `most_seconds`
// at its rate, since the next ones may take longer each; at most 4 times as many as it had, since small work is no
// measure of large work. If the last one had fewer than allowed and was quick, the number stays.
std::uint64_t next_items(std::uint64_t allowed, const MeasuredWork& last, double most_seconds);

// Returns the number of groups of passes that nobody measures, of little work per invocation, that may share a
// submission: a quarter of the groups that take `most_seconds` at 2^17 per second. No limit if that is 0.
std::uint64_t most_groups(double most_seconds);

// Returns a buffer that holds the items for all that is submitted later.
template <class T>
Buffer uploaded(Context& context, const char* name, std::span<const T> data) {
    Buffer buffer(context, {.name = name, .bytes = data.size_bytes()});
    if (data.empty()) return buffer;
    Commands commands(context, name);
    {
        const auto pass = commands.pass(name);
        commands.upload(buffer, data);
    }
    commands.submit();
    return buffer;
}

}  // namespace twinray
