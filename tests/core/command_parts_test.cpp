// SPDX-License-Identifier: MIT
// Commands that become several submissions.
#include <thread>

#include "engine/core/error.h"
#include "engine/core/kernel.h"
#include "engine/core/vma.h"
#include "test_nothing.spv.h"
#include "tests/support/caller.h"
#include "tests/support/device.h"
#include "report/faults/fault_injection.h"

namespace twinray {
namespace {

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
