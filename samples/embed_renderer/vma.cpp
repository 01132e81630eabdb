// SPDX-License-Identifier: MIT
// The renderer's own Vulkan Memory Allocator, beside the one that is hidden in twinray.
#define VMA_IMPLEMENTATION
#include <vk_mem_alloc.h>
