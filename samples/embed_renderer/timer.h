// SPDX-License-Identifier: MIT
// GPU times of the passes of one frame.
#pragma once

#include <string>
#include <vector>

#include "samples/embed_renderer/device.h"

namespace twinray::embed_renderer {

class PassTimer {
  public:
    explicit PassTimer(const Device& device);
    ~PassTimer();
    PassTimer(const PassTimer&) = delete;
    PassTimer& operator=(const PassTimer&) = delete;

    void start(VkCommandBuffer commands);
    // What was recorded since start() or the last lap.
    void lap(VkCommandBuffer commands, const std::string& pass);

    struct Lap {
        std::string pass;
        double ms;
    };
    // Once the GPU has finished the commands.
    std::vector<Lap> laps() const;

  private:
    static constexpr std::uint32_t max_stamps_ = 64;
    void stamp(VkCommandBuffer commands);

    const Device& device_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::uint32_t stamps_ = 0;
    std::vector<std::string> passes_;
};

}  // namespace twinray::embed_renderer
