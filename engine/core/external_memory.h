// SPDX-License-Identifier: MIT
// Buffers whose memory other programs and APIs share.
#pragma once

#include <twinray/commands.h>

#include "engine/core/context.h"

namespace twinray {

struct ExternalBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    ExternalMemory memory;
};

// In memory to be exported, or, with fd >= 0, in memory that another has exported, by a copy of its file descriptor.
// Throws Error naming the buffer.
ExternalBuffer make_external(Context& context, const BufferDesc& desc, VkBufferUsageFlags usage,
                             const ExportedMemory& imported);
void free_external(const Context::State& state, const ExternalBuffer& buffer);
// A new file descriptor.
int export_fd(const Context::State& state, VkDeviceMemory memory, const std::string& name);

}  // namespace twinray
