// SPDX-License-Identifier: MIT
// A device on which nothing runs, so that its driver need not have the hardware: it makes pipelines, and that is all.
#pragma once

#include "engine/core/allocator.h"

namespace twinray {

// Puts functions in the place of those that record, submit, wait or want memory: every semaphore has passed every
// value, query results stay as they are, and addresses are aligned, distinct and of nothing. Objects have no names in
// debuggers.
void run_nothing(VulkanTable& vk);

// What was recorded on such devices by this thread since it asked last.
struct RecordedWork {
    std::uint64_t dispatches = 0, barriers = 0;
    std::uint64_t copies = 0;  // and fills, and updates
};
RecordedWork take_recorded_work();

// What belongs with it: handles of nothing, and where the host maps a buffer, zeros. No images.
AllocatorHooks memoryless_allocator();

}  // namespace twinray
