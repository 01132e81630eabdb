// SPDX-License-Identifier: MIT
#include "samples/embed_renderer/timer.h"

#include "samples/support/text.h"

namespace twinray::embed_renderer {
using samples::fail;

PassTimer::PassTimer(const Device& device) : device_(device) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = max_stamps_;
    require(vkCreateQueryPool(device.handle(), &info, nullptr, &pool_), "create a query pool");
}

PassTimer::~PassTimer() { vkDestroyQueryPool(device_.handle(), pool_, nullptr); }

void PassTimer::start(VkCommandBuffer commands) {
    vkCmdResetQueryPool(commands, pool_, 0, max_stamps_);
    stamps_ = 0;
    passes_.clear();
    stamp(commands);
}

void PassTimer::lap(VkCommandBuffer commands, const std::string& pass) {
    passes_.push_back(pass);
    stamp(commands);
}

// Twice: after a render pass lavapipe takes a stamp only when it comes to the next one, however much lies between.
void PassTimer::stamp(VkCommandBuffer commands) {
    if (stamps_ + 2 > max_stamps_) fail("pass timer: more than ", max_stamps_ / 2 - 1, " passes in a frame");
    for (int i = 0; i < 2; ++i) vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool_, stamps_++);
}

std::vector<PassTimer::Lap> PassTimer::laps() const {
    std::vector<std::uint64_t> ticks(stamps_);
    require(vkGetQueryPoolResults(device_.handle(), pool_, 0, stamps_, ticks.size() * 8, ticks.data(), 8,
                                  VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
            "read timestamps");
    std::vector<Lap> laps;
    for (std::size_t i = 0; i < passes_.size(); ++i)
        laps.push_back(
            {passes_[i], static_cast<double>(ticks[2 * i + 2] - ticks[2 * i]) * device_.timestamp_period_ns() * 1e-6});
    return laps;
}

}  // namespace twinray::embed_renderer
