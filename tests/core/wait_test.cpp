// SPDX-License-Identifier: MIT
// Submissions of twinray's that wait on a timeline of the host.
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <utility>

#include "engine/core/commands.h"
#include "engine/core/error.h"
#include "engine/core/vulkan.h"
#include "tests/core/host_device.h"
#include "tests/support/device.h"
#include "report/faults/fault_injection.h"

namespace twinray {
namespace {

class WaitTest : public test::HostTest {
  protected:
    void SetUp() override {
        test::HostTest::SetUp();
        if (IsSkipped()) return;
        ASSERT_TRUE(host_.create());
        context_ = std::make_unique<Context>(host_.device);
        VkSemaphoreTypeCreateInfo type{};
        type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
        type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
        VkSemaphoreCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        info.pNext = &type;
        ASSERT_EQ(vkCreateSemaphore(host_.device.device, &info, nullptr, &timeline_), VK_SUCCESS);
    }
    void TearDown() override {
        context_.reset();
        if (timeline_) vkDestroySemaphore(host_.device.device, timeline_, nullptr);
    }
    void signal(std::uint64_t value) {
        VkSemaphoreSignalInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO;
        info.semaphore = timeline_;
        info.value = value;
        EXPECT_EQ(vkSignalSemaphore(host_.device.device, &info), VK_SUCCESS);
    }
    Context& context() { return *context_; }
    std::unique_ptr<Context> context_;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
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
    context().wait_before_next_submission({timeline_, 7}, VK_PIPELINE_STAGE_TRANSFER_BIT);
    const SyncPoint copied = commands.submit();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(context().is_reached(copied));
    write(2);
    signal(7);
    context().wait(copied);
    uint value = 0;
    std::memcpy(&value, to.mapped(), 4);
    EXPECT_EQ(value, 2u);
    // The next one does not wait again: the layer would complain of a semaphore that is gone.
    vkDestroySemaphore(host_.device.device, std::exchange(timeline_, VK_NULL_HANDLE), nullptr);
    context().wait(Commands(context(), "does not wait").submit());
}

TEST_F(WaitTest, AWaitForNothingIsRefused) {
    EXPECT_THROW(context().wait_before_next_submission({}), Error);
    EXPECT_THROW(context().wait_before_next_submission({timeline_, 0}), Error);
    EXPECT_THROW(context().wait_before_next_submission({timeline_, 1}, 0), Error);
    context().wait(Commands(context(), "does not wait").submit());
}

// No driver hangs on demand: waiting for it is made to time out.
TEST(HungDevice, IsLostAndNotWaitedForAgain) {
    faults::FaultInjector driver;
    {
        const std::unique_ptr<Context> context =
            test::make_context({.most_wait_seconds = 0.01, .get_instance_proc_addr = driver.entry()});
        if (!context) return;
        driver.inject({"vkWaitSemaphores", 1, faults::every_call, VK_TIMEOUT});
        const SyncPoint point = Commands(*context, "hangs").submit();
        const std::string said = faults::what_is_thrown_by([&] { context->wait(point); });
        EXPECT_NE(said.find("in flight: 'hangs'"), std::string::npos) << said;
        EXPECT_NE(said.find("ended none of its submissions for 0.01 s"), std::string::npos) << said;
        const std::uint64_t calls = driver.calls();
        EXPECT_THROW(context->wait_for_gpu(), DeviceLost);
        EXPECT_EQ(driver.calls(), calls);
        driver.heal();
        // Else what it runs would be left to it.
        const auto reached = [&] {
            std::uint64_t value = 0;
            context->state().vk().vkGetSemaphoreCounterValue(context->device(), point.semaphore, &value);
            return value;
        };
        while (reached() < point.value) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(driver.live().empty());
}

}  // namespace
}  // namespace twinray
