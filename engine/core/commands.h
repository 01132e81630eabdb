// SPDX-License-Identifier: MIT
// The command buffers that Commands consists of, and the alignment that the library itself uses for buffers.
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
    std::vector<PassTiming> timings_of(const Part& part) const;
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

}  // namespace twinray
