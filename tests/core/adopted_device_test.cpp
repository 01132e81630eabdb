// SPDX-License-Identifier: MIT
// A device that the host made: both accelerators trace on it, and submissions wait on a timeline of the host.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include <twinray/geometry.h>
#include <twinray/queries.h>
#include <twinray/tlas.h>
#include "engine/core/commands.h"
#include "engine/core/context.h"
#include "engine/core/error.h"
#include "tests/core/host_device.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/caller.h"

namespace twinray {
namespace {

class AdoptedDeviceTest : public test::HostTest {
  protected:
    // Expects an Error that says this when the device is adopted.
    void expect_refusal(const std::string& part) {
        test::expect_error(part, [&] { const Context context(host_.device); });
    }
};

void expect_both_trace(const AdoptedDevice& device) {
    Context context(device);
    std::vector<std::unique_ptr<AbstractAccel>> accels;
    accels.push_back(std::make_unique<SwTlas>(context));
    if (missing_for_hardware(context.properties()).empty()) accels.push_back(std::make_unique<HwTlas>(context));
    for (const std::unique_ptr<AbstractAccel>& accel : accels) {
        accel->push(make_box(vec3(-1), vec3(1)));
        const Ray ray{vec3(0.25f, 0.5f, 5), 0, vec3(0, 0, -1), INFINITY};
        EXPECT_EQ(accel->closest_hits(std::span(&ray, 1)).front().t, 4.0f) << accel->name();
    }
}

TEST_F(AdoptedDeviceTest, BothAcceleratorsTraceOnIt) {
    ASSERT_TRUE(host_.create());
    expect_both_trace(host_.device);
    EXPECT_EQ(host_.locked, 0) << "each lock of the queue is undone";
    EXPECT_GT(host_.submissions, 0);
    EXPECT_TRUE(host_.device.enabled.shader_int64) << "as the host enabled it";
}

TEST_F(AdoptedDeviceTest, TheHostSaysHowLongASubmissionMayTake) {
    ASSERT_TRUE(host_.create());
    host_.device.most_submission_seconds = 0.125;
    EXPECT_EQ(Context(host_.device).state().tuning().most_submission_seconds, 0.125);
}

// The layer complains of a queue that two threads use at once.
TEST_F(AdoptedDeviceTest, TheHostSubmitsFromAnotherThreadUnderTheSameLock) {
    ASSERT_TRUE(host_.create());
    std::mutex mutex;
    host_.device.lock_queue = [&] { mutex.lock(); };
    host_.device.unlock_queue = [&] { mutex.unlock(); };
    std::atomic<bool> is_over = false;
    std::thread other([&] {
        while (!is_over) {
            {
                const std::lock_guard lock(mutex);
                vkQueueSubmit(host_.device.queue, 0, nullptr, VK_NULL_HANDLE);
            }
            // Otherwise the validation layer falls behind, and reports that it has waited for 10 s.
            std::this_thread::sleep_for(std::chrono::microseconds(50));
        }
    });
    {
        Context context(host_.device);
        for (int i = 0; i < 500; ++i) Commands(context, "nothing").submit();
    }
    is_over = true;
    other.join();
}

// The host has features and extensions of its own, some of them the same: the layer would complain of duplicates.
TEST_F(AdoptedDeviceTest, BothAcceleratorsTraceOnADeviceThatEnablesMore) {
    VkPhysicalDeviceVulkan12Features own{};
    own.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    own.hostQueryReset = VK_TRUE;
    VkPhysicalDeviceFeatures old_style{};
    const char* extensions[] = {VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
    host_.extend = [&](VkDeviceCreateInfo& info) {
        old_style.shaderFloat64 = host_.supported.shader_float64;
        info.pNext = &own;
        info.pEnabledFeatures = &old_style;
        info.enabledExtensionCount = host_.supported.acceleration_structure ? 1 : 0;
        info.ppEnabledExtensionNames = extensions;
    };
    ASSERT_TRUE(host_.create());
    EXPECT_TRUE(own.hostQueryReset && own.timelineSemaphore);
    EXPECT_EQ(host_.device.enabled.shader_float64, host_.supported.shader_float64);
    expect_both_trace(host_.device);
}

TEST_F(AdoptedDeviceTest, SoftwareAloneTracesWithoutTheExtensions) {
    host_.wants_hardware = false;
    ASSERT_TRUE(host_.create());
    EXPECT_FALSE(missing_for_hardware(host_.device.enabled).empty());
    expect_both_trace(host_.device);
}

// The error comes before a kernel is made: SwiftShader ends the process if one computes in float64.
TEST_F(AdoptedDeviceTest, DistancesAndContactsNeedFloat64) {
    host_.wants_float64 = false;
    ASSERT_TRUE(host_.create());
    Context context(host_.device);
    const std::string need = "need float64 (shaderFloat64), which device";
    test::expect_error(need, [&] { PointQuery query(context); });
    test::expect_error(need, [&] { NarrowPhase phase(context); });
}

// A host that tells what the driver supports instead of what it enabled.
TEST_F(AdoptedDeviceTest, AnExtensionThatWasNotEnabledIsNotBelieved) {
    host_.wants_hardware = false;
    ASSERT_TRUE(host_.create());
    if (!host_.supported.acceleration_structure) TWINRAY_LACKS("ray_tracing", "no ray tracing extensions");
    host_.device.enabled = host_.supported;
    expect_refusal("VK_KHR_acceleration_structure is listed as enabled, but the VkDevice was created without");
}

TEST_F(AdoptedDeviceTest, WhatItLacksIsRefusedInWords) {
    ASSERT_TRUE(host_.create());
    const AdoptedDevice whole = host_.device;
    host_.device.enabled.timeline_semaphore = false;
    expect_refusal("twinray needs timelineSemaphore because it never waits for the GPU");
    host_.device = whole;
    host_.device.api_version = VK_API_VERSION_1_1;
    expect_refusal("twinray needs Vulkan 1.2");
    host_.device = whole;
    host_.device.queue_family = 99;
    expect_refusal("queue family 99 does not exist");
}

// The layer would complain of a cache that is destroyed twice.
TEST_F(AdoptedDeviceTest, PipelinesGoIntoTheHostsCache) {
    ASSERT_TRUE(host_.create());
    VkPipelineCacheCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    VkPipelineCache& cache = host_.device.pipeline_cache;
    ASSERT_EQ(vkCreatePipelineCache(host_.device.device, &info, nullptr, &cache), VK_SUCCESS);
    EXPECT_EQ(Context(host_.device).state().pipeline_cache(), cache);
    expect_both_trace(host_.device);
    vkDestroyPipelineCache(host_.device.device, cache, nullptr);
}

class WaitTest : public test::VulkanTest {
  protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (!IsSkipped() && !HasFailure()) caller_.emplace(context());
    }
    void TearDown() override {
        caller_.reset();
        VulkanTest::TearDown();
    }
    std::optional<test::Caller> caller_;
};

TEST_F(WaitTest, ASubmissionSeesWhatTheHostWroteBeforeItsSignal) {
    const Buffer from(context(), {.name = "from", .bytes = 4, .memory = Memory::upload});
    const Buffer to(context(), {.name = "to", .bytes = 4, .memory = Memory::readback});
    const auto write = [&](uint value) { std::memcpy(from.mapped(), &value, 4); };
    write(1);
    Commands commands(context(), "copy");
    {
        const auto pass = commands.pass("copy");
        commands.copy(from, 0, to, 0, 4);
    }
    context().wait_before_next_submission(caller_->begin().done, VK_PIPELINE_STAGE_TRANSFER_BIT);
    const SyncPoint copied = commands.submit();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(context().is_reached(copied));
    write(2);
    caller_->signal();
    context().wait(copied);
    uint value = 0;
    std::memcpy(&value, to.mapped(), 4);
    EXPECT_EQ(value, 2u);
    // The next one does not wait again: the layer would complain of a semaphore that is gone.
    caller_.reset();
    context().wait(Commands(context(), "does not wait").submit());
}

TEST_F(WaitTest, AWaitForNothingIsRefused) {
    EXPECT_THROW(context().wait_before_next_submission({}), Error);
    const SyncPoint done = caller_->begin().done;
    EXPECT_THROW(context().wait_before_next_submission({done.semaphore, 0}), Error);
    EXPECT_THROW(context().wait_before_next_submission(done, 0), Error);
    context().wait(Commands(context(), "does not wait").submit());
}

}  // namespace
}  // namespace twinray
