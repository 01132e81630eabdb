// SPDX-License-Identifier: MIT
// A device on which nothing runs, so that its driver need not have the hardware: it makes pipelines, and that is all.
#pragma once

#include "engine/core/allocator.h"

namespace twinray {

// Puts functions in the place of those that record, submit, wait or want memory: every semaphore has passed every
// value, query results stay as they are, and addresses are aligned, distinct and of nothing. Objects have no names in
// debuggers.
void run_nothing(VulkanFunctions& vk);

// What belongs with it: handles of nothing, and where the host maps a buffer, zeros. No images.
AllocatorHooks memoryless_allocator();

}  // namespace twinray
