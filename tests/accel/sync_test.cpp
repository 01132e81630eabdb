// sync() never waits, does nothing on a clean accelerator, and records into the caller's command buffer.
#include <chrono>
#include <cstdio>

#include "engine/core/context.h"
#include "tests/accel/accel_fixture.h"
#include "tests/support/caller.h"

namespace twinray {
namespace {

using test::down;
using test::expect_error;
using test::square;
using Clock = std::chrono::steady_clock;

double microseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

class Sync : public test::AccelTest {
  protected:
    bool shares_context() const override { return false; }  // the tests count memory and submissions
    // The queue waits until release_queue() says so.
    SyncPoint occupy_queue() {
        if (!caller_) caller_ = std::make_unique<test::Caller>(context());
        context().wait_before_next_submission(caller_->begin().done);
        is_occupied_ = true;
        return Commands(context(), "occupy").submit();
    }
    void release_queue() {
        if (is_occupied_) caller_->signal();
        is_occupied_ = false;
    }

    using Record = std::function<void(Commands&)>;
    // Moves a square, and pushes another in the fourth frame. `submit` records a sync and a trace of each frame.
    void expect_frames(const std::function<void(const Record&)>& submit) {
        const AccelHandle handle = accel().push(square(0));
        const Buffer rays = device_copy(std::vector<Ray>{down(0.5f, 0.25f)});
        const Buffer hits(context(), {.name = "hits", .bytes = sizeof(Hit)});
        for (int frame = 0; frame < 5; ++frame) {
            const auto height = static_cast<float>(frame);
            accel().update_transform(handle, Transform::translation({0, 0, height}));
            if (frame == 3) accel().push(square(5));
            submit([&](Commands& commands) {
                accel().sync(commands);
                accel().trace(commands, accel().view(), {.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(), .count = 1});
            });
            EXPECT_EQ(accel().world_bound().lo.z, height);
            EXPECT_EQ(download<Hit>(context(), hits, 1).front().t, frame < 3 ? 10.0f - height : 5.0f);
        }
    }

    void TearDown() override {
        release_queue();
        caller_.reset();
        test::AccelTest::TearDown();
    }

  private:
    std::unique_ptr<test::Caller> caller_;
    bool is_occupied_ = false;
};
TWINRAY_OVER_EVERY_ACCEL(Sync);

TEST_P(Sync, NeverWaitsWhileTheQueueIsBusy) {
    const AccelHandle mover = accel().push(square(0), std::vector<Transform>(100));
    const AccelHandle shaken = accel().push(make_icosphere(3), Transform::translation({20, 0, 0}));
    accel().sync();
    accel().update_transforms(mover, std::vector<Transform>(100));
    context().wait(accel().sync());
    const SyncPoint busy = occupy_queue();
    std::vector<double> times;
    std::vector<AccelHandle> pushed;
    for (int i = 0; i < 100; ++i) {
        if (i % 10 == 5)
            pushed.push_back(accel().push(square(1), Transform::translation({0, 0, 0.01f * static_cast<float>(i)})));
        if (i % 20 == 15) accel().erase(pushed.front());
        accel().update_transform_at(mover, static_cast<std::size_t>(i),
                                    Transform::translation({3, 0, static_cast<float>(i)}));
        if (i % 4 == 0) accel().update_vertices(shaken, make_icosphere(3).positions);
        const auto start = Clock::now();
        accel().sync();
        times.push_back(microseconds_since(start));
    }
    EXPECT_FALSE(context().is_reached(busy));
    std::sort(times.begin(), times.end());
    std::printf("100 syncs behind a busy queue: median %.0f, 95 %% below %.0f, longest %.0f microseconds\n", times[50],
                times[95], times[99]);
    EXPECT_LT(times[50], 50'000);
    EXPECT_LT(times[99], 1'000'000) << "one of them waited";
    EXPECT_EQ(accel().world_bound_if_ready(), std::nullopt);
    EXPECT_EQ(accel().sah_if_ready(), std::nullopt);
    release_queue();
    EXPECT_EQ(closest(down(3.5f, 0.25f)).hit, 1u);
    EXPECT_EQ(accel().world_bound().hi.z, 99.0f);
    EXPECT_TRUE(context().is_reached(busy));
}

// Data that a view reads is freed by the sync that ends it, not by the edit before: traces through the view may be
// submitted in between.
TEST_P(Sync, WhatAViewReadsIsFreedByTheNextOne) {
    const std::uint64_t before = context().allocated_bytes();
    {
        const std::unique_ptr<AbstractAccel> refined = make_accel({.level = Level::refined});
        const AccelHandle erased = refined->push(make_icosphere(2)), replaced = refined->push(make_icosphere(3));
        refined->sync();
        context().wait_for_gpu();
        const std::uint64_t synced = context().allocated_bytes();
        refined->update(replaced, square(0));
        refined->erase(erased);
        context().wait_for_gpu();
        EXPECT_EQ(context().allocated_bytes(), synced);
        refined->erase(replaced);
        context().wait_for_gpu();
        EXPECT_EQ(context().allocated_bytes(), synced) << "after an update without a sync";
        refined->sync();
        context().wait_for_gpu();
        EXPECT_LT(context().allocated_bytes(), synced);
        for (int i = 0; i < 3; ++i) refined->erase(refined->push(square(0)));
        context().wait_for_gpu();
        const std::uint64_t idle = context().allocated_bytes();
        for (int i = 0; i < 3; ++i) refined->erase(refined->push(square(0)));
        context().wait_for_gpu();
        EXPECT_EQ(context().allocated_bytes(), idle) << "what no view has seen goes at once";
    }
    context().wait_for_gpu();
    EXPECT_EQ(context().allocated_bytes(), before);
}

TEST_P(Sync, ACleanOneIsFree) {
    accel().push(square(0));
    const SyncPoint done = accel().sync();
    context().wait_for_gpu();
    const std::uint64_t bytes = context().allocated_bytes();
    const auto start = Clock::now();
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(accel().sync().value, done.value);
    const double each = microseconds_since(start) / 1000;
    std::printf("a clean sync takes %.4f microseconds\n", each);
    EXPECT_LT(each, 1);
    EXPECT_EQ(context().allocated_bytes(), bytes);
    EXPECT_EQ(context().last_submission().value, done.value);
}

// Measures memory in use before the GPU has built; then compares the hits of the rays.
TEST_P(Sync, TheScratchBudgetBoundsWhatABuildTakes) {
    std::vector<Mesh> meshes;
    for (uint i = 0; i < 60; ++i) meshes.push_back(make_soup(1000 + i, i));
    std::uint64_t in_flight[3][2];
    std::vector<Hit> hits[3];
    constexpr std::uint64_t budgets[] = {0, 1 << 20, UINT64_MAX};
    EXPECT_EQ(accel().scratch_budget(), std::uint64_t{64 << 20});
    for (std::size_t i = 0; i < 3; ++i) {
        const std::unique_ptr<AbstractAccel> built = make_accel();
        built->set_scratch_budget(budgets[i]);
        EXPECT_EQ(built->scratch_budget(), budgets[i]);
        std::vector<AccelHandle> handles;
        for (const Mesh& mesh : meshes) handles.push_back(built->push(mesh));
        for (const std::size_t step : {0u, 1u}) {
            context().wait_for_gpu();
            const SyncPoint busy = occupy_queue();
            built->sync();
            in_flight[i][step] = context().allocated_bytes();
            EXPECT_FALSE(context().is_reached(busy));
            release_queue();
            for (std::size_t k = 0; k < meshes.size(); ++k) built->update_vertices(handles[k], meshes[k].positions);
        }
        std::vector<Ray> rays;
        for (int k = 0; k < 500; ++k)
            rays.push_back(down(static_cast<float>(k % 25) / 25, static_cast<float>(k) / 500));
        hits[i] = built->closest_hits(rays);
        EXPECT_TRUE(std::memcmp(hits[i].data(), hits[0].data(), hits[0].size() * sizeof(Hit)) == 0) << budgets[i];
    }
    for (const std::size_t step : {0u, 1u}) {
        EXPECT_LE(in_flight[1][step], in_flight[0][step] + budgets[1]);
        EXPECT_TRUE(!is_ours() || in_flight[2][step] > in_flight[1][step]);
    }
}

TEST_P(Sync, BuildsAndTracesInTheCallersCommandBufferOnTheCallersTimeline) {
    test::Caller caller(context());
    expect_frames([&](const Record& record) {
        const SyncPoint own = context().last_submission();
        const CallerCommands buffer = caller.record("frame", record);
        EXPECT_EQ(context().last_submission().value, own.value) << "twinray submitted something itself";
        EXPECT_EQ(accel().world_bound_if_ready(), std::nullopt);
        caller.submit(buffer);
    });
}

TEST_P(Sync, WhatTheCallersCommandsUseOutlivesThem) {
    test::Caller caller(context());
    accel().push(make_icosphere(4));
    context().wait(accel().sync());
    const AccelView view = accel().view();
    const Buffer rays = device_copy(std::vector<Ray>{down(0.1f, 0.2f)});
    const Buffer hits(context(), {.name = "hits", .bytes = sizeof(Hit)});
    context().wait_for_gpu();
    const CallerCommands buffer = caller.record("late frame", [&](Commands& commands) {
        accel().trace(commands, view, {.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(), .count = 1});
    });
    const std::uint64_t bytes = context().allocated_bytes();
    drop_accel();
    context().wait(Commands(context(), "collects").submit());
    Commands(context(), "collects").submit();
    EXPECT_EQ(context().allocated_bytes(), bytes) << "freed before the caller's commands are done";
    caller.submit(buffer);
    EXPECT_NEAR(download<Hit>(context(), hits, 1).front().t, 9.0f, 0.1f);
}

TEST_P(Sync, CallersCommandsMustBeComplete) {
    expect_error("command buffer is null", [&] { Commands(context(), "frame", CallerCommands{}); });
    test::Caller caller(context());
    CallerCommands buffer = caller.begin();
    buffer.done.value = 0;
    expect_error("with which semaphore and value", [&] { Commands(context(), "frame", buffer); });
}

TEST_P(Sync, OwnCommandsBuildAndTraceInOneSubmission) {
    expect_frames([&](const Record& record) {
        Commands commands(context(), "frame");
        record(commands);
        EXPECT_EQ(accel().world_bound_if_ready(), std::nullopt);
        expect_error("must be submitted first", [&] { accel().world_bound(); });
        expect_error("must be submitted first", [&] { accel().sync(); });
        commands.submit();
    });
}

TEST_P(Sync, OwnCommandsAreSubmittedInTheOrderOfTheirSyncs) {
    const auto other = make_accel();
    const AccelHandle handle = accel().push(square(0));
    other->push(square(1));
    std::optional<Commands> first, second, third;
    first.emplace(context(), "first");
    second.emplace(context(), "second");
    third.emplace(context(), "third");
    accel().sync(*first);
    other->sync(*second);
    accel().update_transform(handle, Transform::translation({0, 0, 2}));
    accel().sync(*third);
    expect_error("commands 'third': others", [&] { third->submit(); });
    context().wait_for_gpu();  // does not wait for commands that nobody has submitted
    first->submit();
    second.reset();  // given up
    third->submit();
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 8.0f);
    // The discarded work does not exist.
    expect_error("were discarded", [&] { other->sync(); });
    expect_error("were discarded", [&] { other->world_bound(); });
    std::optional<Commands> last;
    last.emplace(context(), "last");
    accel().update_transform(handle, Transform::translation({0, 0, 4}));
    accel().sync(*last);
    last.reset();
    context().wait_for_gpu();
    expect_error("were discarded", [&] { closest(down(0.5f, 0.25f)); });
}

}  // namespace
}  // namespace twinray
