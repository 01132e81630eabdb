// Failures of Vulkan without an accelerator: see tests/accel/fault_test.cpp for those with one. Commands that become
// several submissions.
#include <chrono>

#include <thread>

#include "engine/core/kernel.h"
#include "engine/core/context.h"
#include "report/faults/fault_injection.h"
#include "test_nothing.spv.h"
#include "tests/support/caller.h"
#include "tests/support/device.h"

namespace twinray {
namespace {

using faults::Counts;
using faults::every_call;
using faults::FaultInjector;
using faults::may_be_harmless;
using faults::Outcome;
using faults::outcome_of;

class FaultsOfCore : public ::testing::Test {
  protected:
    void SetUp() override { context_ = test::make_context({.get_instance_proc_addr = faults_.entry()}); }
    void TearDown() override {
        if (!context_) return;
        for (const std::string& message : context_->validation_messages()) ADD_FAILURE() << message;
        context_.reset();
        EXPECT_TRUE(faults_.live().empty());
        EXPECT_EQ(faults_.wrong_destructions(), 0u);
    }
    FaultInjector& faults() { return faults_; }
    Context& context() { return *context_; }
    // Returns whether wait_for_gpu() has anything to wait for.
    bool must_wait() {
        faults_.inject({.function = "vkWaitSemaphores", .count = every_call});
        const Outcome outcome = outcome_of([&] { context_->wait_for_gpu(); });
        faults_.heal();
        return outcome != Outcome::done;
    }

  private:
    FaultInjector faults_;
    std::unique_ptr<Context> context_;
};

TEST_F(FaultsOfCore, MemoryThatCannotBeMappedIsRefused) {
    faults().inject({.function = "vkMapMemory", .count = every_call});
    // The buffer is too large for the block that is mapped already.
    const BufferDesc staged{.name = "staged", .bytes = 1 << 28, .memory = Memory::upload};
    std::string what;
    EXPECT_EQ(outcome_of([&] { Buffer(context(), staged); }, &what), Outcome::error);
    EXPECT_NE(what.find("buffer 'staged' of 268435456 bytes"), std::string::npos) << what;
    faults().heal();
    EXPECT_NE(Buffer(context(), staged).mapped(), nullptr);
}

TEST_F(FaultsOfCore, CommandsWhoseSubmissionFailedAreSpent) {
    for (const char* function : {"vkEndCommandBuffer", "vkQueueSubmit"}) {
        Commands commands(context(), "spent");
        faults().inject({.function = function});
        EXPECT_EQ(outcome_of([&] { commands.submit(); }), Outcome::error);
        faults().heal();
        EXPECT_EQ(outcome_of([&] { commands.submit(); }), Outcome::error);
        EXPECT_EQ(outcome_of([&] { static_cast<void>(commands.pass("late")); }), Outcome::error);
    }
    Commands(context(), "after").submit();
}

TEST_F(FaultsOfCore, AFailedSubmissionLeavesItsWaitToTheNext) {
    test::Caller host(context());
    context().wait_before_next_submission(host.begin().done);
    Commands failing(context(), "failing"), waiting(context(), "waiting");
    faults().inject({.function = "vkQueueSubmit"});
    EXPECT_EQ(outcome_of([&] { failing.submit(); }), Outcome::error);
    faults().heal();
    const SyncPoint point = waiting.submit();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(context().is_reached(point));
    host.signal();
    context().wait(point);
}

TEST_F(FaultsOfCore, RecordingForTheHost) {
    const Buffer target(context(), {.name = "target", .bytes = 16});
    const std::vector<uint> values(4);
    test::Caller host(context());
    for (std::uint64_t n = 1; !HasFailure(); ++n) {
        context().wait_for_gpu();
        const Counts before = faults().live_objects();
        const std::uint64_t bytes = context().allocated_bytes();
        const CallerCommands recorded = host.begin();
        faults().inject({.first = n});
        const Outcome outcome = outcome_of([&] {
            Commands commands(context(), "for the host", recorded);
            const auto pass = commands.pass("upload");
            commands.upload(target, std::span<const uint>(values));
        });
        faults().heal();
        SCOPED_TRACE(text("call ", n, ", ", faults().failed()));
        EXPECT_TRUE(outcome == (faults().injected() ? Outcome::error : Outcome::done) ||
                    may_be_harmless(faults().failed()));
        const bool is_over = !faults().injected();
        EXPECT_FALSE(n == 1 && must_wait()) << "for commands that were never begun";
        host.submit(recorded);
        context().wait_for_gpu();
        EXPECT_EQ(context().allocated_bytes(), bytes);
        EXPECT_EQ(faults().live_objects(), before);
        if (is_over) break;
    }
}

// Lists the devices by another instance, beside the context's.
TEST_F(FaultsOfCore, ListingTheDevices) {
    const Counts before = faults().live();
    for (std::uint64_t n = 1; !HasFailure(); ++n) {
        faults().inject({.first = n});
        const Outcome outcome = outcome_of([&] { list_devices(faults().entry()); });
        faults().heal();
        SCOPED_TRACE(text("call ", n, ", ", faults().failed()));
        EXPECT_EQ(faults().live(), before);
        EXPECT_EQ(outcome, faults().injected() ? Outcome::error : Outcome::done);
        if (!faults().injected()) return;
    }
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
        // Otherwise the context would go while the device is still at work.
        const auto reached = [&] {
            std::uint64_t value = 0;
            context->state().vk().vkGetSemaphoreCounterValue(context->device(), point.semaphore, &value);
            return value;
        };
        while (reached() < point.value) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(driver.live().empty());
}

struct PartArgs {
    uint value;
};

class CommandPartsTest : public test::VulkanTest {
  protected:
    ContextDesc context_desc() const override {
        return {.most_submission_seconds = 1e-9, .get_instance_proc_addr = faults_.entry()};
    }
    std::uint64_t submissions() { return context().last_submission().value; }
    // Records three passes of a group and one that copies.
    void record(Commands& commands, const Buffer& from, const Buffer& to) {
        const Kernel<PartArgs> nothing(context(), {.name = "nothing", .spirv = test_nothing_spirv});
        for (int i = 0; i < 3; ++i) nothing.dispatch(commands, {0}, 1);
        const auto pass = commands.pass("copy");
        commands.copy(from, 0, to, 0, 4);
    }
    Buffer word(Memory memory) { return Buffer(context(), {.name = "word", .bytes = 4, .memory = memory}); }

    faults::FaultInjector faults_;
};

std::vector<std::string> names(const std::vector<PassTiming>& timings) {
    std::vector<std::string> names;
    for (const PassTiming& pass : timings) names.push_back(pass.name);
    return names;
}

TEST_F(CommandPartsTest, AreCutBetweenPassesThatAreTooLargeTogether) {
    const Buffer from = word(Memory::upload), to = word(Memory::readback);
    *reinterpret_cast<uint*>(from.mapped()) = 42;
    const std::uint64_t before = submissions();
    Commands commands(context(), "parts");
    record(commands, from, to);
    EXPECT_EQ(submissions(), before) << "nothing runs before it is submitted";
    context().wait(commands.submit());
    EXPECT_EQ(submissions(), before + 4);
    EXPECT_EQ(*reinterpret_cast<const uint*>(to.mapped()), 42u);
    if (context().state().timestamp_period_ns() > 0) {
        EXPECT_EQ(names(commands.timings()), (std::vector<std::string>{"nothing", "nothing", "nothing", "copy"}));
    }
}

TEST_F(CommandPartsTest, AreSubmittedAllOrNone) {
    const Buffer from = word(Memory::upload), to = word(Memory::readback);
    const std::uint64_t before = submissions();
    Commands commands(context(), "parts");
    record(commands, from, to);
    faults_.inject({.function = "vkQueueSubmit"});
    EXPECT_EQ(faults::outcome_of([&] { commands.submit(); }), faults::Outcome::error);
    EXPECT_EQ(faults_.calls(), 1u) << "one call for all";
    faults_.heal();
    EXPECT_EQ(submissions(), before);
}

TEST_F(CommandPartsTest, AllWaitForTheHost) {
    const Buffer from = word(Memory::upload), to = word(Memory::readback);
    test::Caller host(context());
    context().wait_before_next_submission(host.begin().done, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT);
    Commands commands(context(), "parts");
    record(commands, from, to);
    const SyncPoint last = commands.submit();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(context().is_reached({last.semaphore, last.value - 3}));
    *reinterpret_cast<uint*>(from.mapped()) = 7;
    host.signal();
    context().wait(last);
    EXPECT_EQ(*reinterpret_cast<const uint*>(to.mapped()), 7u);
}

TEST_F(CommandPartsTest, APartRunsAtOnceAndMoreMayFollow) {
    const Buffer target(context(), {.name = "target", .bytes = 8});
    Commands commands(context(), "parts");
    const std::uint64_t bytes = context().allocated_bytes();
    const auto write = [&](const std::string& name, uint value, std::uint64_t offset) {
        const auto pass = commands.pass(name);
        commands.upload(target, offset, std::as_bytes(std::span(&value, 1)));
    };
    write("first", 1, 0);
    EXPECT_GT(context().allocated_bytes(), bytes);
    EXPECT_GE(commands.submit_part(), 0);
    context().wait_for_gpu();
    EXPECT_EQ(context().allocated_bytes(), bytes) << "staging goes with its part";
    EXPECT_EQ(download<uint>(context(), target, 1).front(), 1u);
    write("second", 2, 4);
    commands.submit();
    EXPECT_EQ(download<uint>(context(), target, 2), (std::vector<uint>{1, 2}));
    if (context().state().timestamp_period_ns() > 0) {
        EXPECT_EQ(names(commands.timings()), (std::vector<std::string>{"first", "second"}));
    }
    EXPECT_EQ(faults::outcome_of([&] { commands.submit_part(); }), faults::Outcome::error) << "submitted twice";
}

TEST_F(CommandPartsTest, APassIsNotCut) {
    Commands commands(context(), "parts");
    const auto pass = commands.pass("open");
    EXPECT_EQ(faults::outcome_of([&] { commands.submit_part(); }), faults::Outcome::error);
}

TEST_F(CommandPartsTest, WhoseSubmissionFailsAreSpent) {
    for (const char* function : {"vkQueueSubmit", "vkWaitSemaphores", "vkCreateCommandPool"}) {
        Commands commands(context(), "parts");
        faults_.inject({.function = function});
        EXPECT_EQ(faults::outcome_of([&] { commands.submit_part(); }), faults::Outcome::error) << function;
        faults_.heal();
        EXPECT_EQ(faults::outcome_of([&] { commands.submit(); }), faults::Outcome::error) << function;
        EXPECT_EQ(faults::outcome_of([&] { static_cast<void>(commands.pass("late")); }), faults::Outcome::error);
        context().wait_for_gpu();
    }
    Commands(context(), "after").submit();
}

}  // namespace
}  // namespace twinray
