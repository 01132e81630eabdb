// SPDX-License-Identifier: MIT
// Copies of bottom levels into the memory that they have turned out to need.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hwtlas/acceleration_structure.h"

namespace twinray {

// How many bytes structures of one build need at least, asked of the GPU when they were built.
class CompactedSizes {
  public:
    // Records the question in a pass of its own. The builds allowed compaction and are in earlier passes.
    CompactedSizes(Commands& commands, std::span<const AccelerationStructure* const> structures);
    ~CompactedSizes();
    CompactedSizes(const CompactedSizes&) = delete;
    CompactedSizes& operator=(const CompactedSizes&) = delete;

    // Of the structure at `index`; nothing while the GPU has not reached `built`, at which the commands are done.
    std::optional<std::uint64_t> of(std::size_t index, SyncPoint built);
    // The same once it has been told.
    std::uint64_t bytes_of(std::size_t index) const;

  private:
    Context& context_;
    Buffer bytes_;  // a word each, copied by the GPU: some drivers let vkGetQueryPoolResults wait for the whole queue
    VkQueryPool queries_ = VK_NULL_HANDLE;
    bool is_told_ = false;
};

// Records a copy of `bytes` bytes, in the caller's pass.
AccelerationStructure record_compaction(Commands& commands, const std::string& name,
                                        const AccelerationStructure& structure, std::uint64_t bytes);

}  // namespace twinray
