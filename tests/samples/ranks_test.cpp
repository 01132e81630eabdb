// SPDX-License-Identifier: MIT
#include "renderer/ranks.h"

#include <gtest/gtest.h>

namespace twinray::path_tracer {
namespace {

DeviceProperties device(DeviceKind kind) {
    DeviceProperties properties;
    properties.kind = kind;
    properties.api_version = VK_API_VERSION_1_3;
    properties.has_compute_queue = properties.timeline_semaphore = properties.buffer_device_address = true;
    properties.scalar_block_layout = properties.shader_int64 = true;
    properties.group_invocations = 1024;
    return properties;
}

TEST(Ranks, TakeTurnsOnTheBestDevices) {
    const std::vector<DeviceProperties> machine = {device(DeviceKind::cpu), device(DeviceKind::discrete),
                                                   device(DeviceKind::integrated), device(DeviceKind::discrete)};
    EXPECT_EQ(device_of_rank(machine, 0), 1u);
    EXPECT_EQ(device_of_rank(machine, 1), 3u);
    EXPECT_EQ(device_of_rank(machine, 2), 1u);
    EXPECT_EQ(device_of_rank(std::span(machine).first(1), 5), 0u);
    EXPECT_EQ(device_of_rank({}, 1), 0u);
}

}  // namespace
}  // namespace twinray::path_tracer
