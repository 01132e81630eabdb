// SPDX-License-Identifier: MIT
// The renderer's command buffers, one frame at a time, on a timeline of its own.
#pragma once

#include <twinray/context.h>
#include "samples/embed_renderer/device.h"

namespace twinray::embed_renderer {

class FrameCommands {
  public:
    explicit FrameCommands(const Device& device);
    ~FrameCommands();
    FrameCommands(const FrameCommands&) = delete;
    FrameCommands& operator=(const FrameCommands&) = delete;

    // The last frame must be done.
    VkCommandBuffer begin();
    // When what is being recorded will be done.
    SyncPoint done() const { return {timeline_, submitted_ + 1}; }
    void submit();
    void wait() const;  // for the last frame

  private:
    void destroy();

    const Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    std::uint64_t submitted_ = 0;
};

}  // namespace twinray::embed_renderer
