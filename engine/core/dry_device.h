// SPDX-License-Identifier: MIT
// A device on which nothing runs, so that its driver need not have the hardware: it only makes pipelines.
#pragma once

#include "engine/core/allocator.h"

namespace twinray {

// Replaces the functions that record, submit, wait or allocate memory: every semaphore has passed every value, query
// results stay as they are, and addresses are aligned and distinct without memory. Objects have no names in debuggers.
void run_nothing(VulkanTable& vk);

// The work recorded on such devices by this thread since its last query.
struct RecordedWork {
    std::uint64_t dispatches = 0, barriers = 0;
    std::uint64_t copies = 0;  // and fills, and updates
};
RecordedWork take_recorded_work();

// Returns the allocator for them: null handles, and zeros in buffers that the host maps. No images.
AllocatorHooks memoryless_allocator();

}  // namespace twinray
