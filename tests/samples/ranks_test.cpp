// SPDX-License-Identifier: MIT
#include "samples/path_tracer/ranks.h"

#include <gtest/gtest.h>

namespace twinray::path_tracer {
namespace {

DeviceFacts device(DeviceKind kind) {
    DeviceFacts facts;
    facts.kind = kind;
    facts.api_version = VK_API_VERSION_1_3;
    facts.has_compute_queue = facts.timeline_semaphore = facts.buffer_device_address = true;
    facts.scalar_block_layout = facts.shader_int64 = true;
    facts.group_invocations = 1024;
    return facts;
}

TEST(Ranks, TakeTurnsOnTheBestDevices) {
    const std::vector<DeviceFacts> machine = {device(DeviceKind::cpu), device(DeviceKind::discrete),
                                              device(DeviceKind::integrated), device(DeviceKind::discrete)};
    EXPECT_EQ(device_of_rank(machine, 0), 1u);
    EXPECT_EQ(device_of_rank(machine, 1), 3u);
    EXPECT_EQ(device_of_rank(machine, 2), 1u);
    EXPECT_EQ(device_of_rank(std::span(machine).first(1), 5), 0u);
    EXPECT_EQ(device_of_rank({}, 1), 0u);
}

}  // namespace
}  // namespace twinray::path_tracer
