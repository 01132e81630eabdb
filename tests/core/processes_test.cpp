// Contexts in forked processes, calls whose caller wants them to end, and a full disk, imitated by the limit on the
// size of files.
#include <sys/wait.h>

#include <csignal>
#include <sys/resource.h>
#include <unistd.h>

#include "engine/core/interruption.h"
#include "engine/core/parallel.h"
#include "tests/accel/accel_fixture.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

class ProcessesTest : public test::AccelTest {
  protected:
    // A program that is compiled in the background has a thread of its own, which is the parent's.
    AccelOptions accel_options() const override { return {.compiles_in_background = true}; }
    bool shares_context() const override { return false; }

    // Returns the status with which a child process ended that did this; it has 60 s.
    template <class Action>
    static int status_of_child(const Action& action) {
        const pid_t child = fork();
        if (child == 0) {
            alarm(60);
            _exit(action());
        }
        int status = 0;
        waitpid(child, &status, 0);
        return status;
    }
};

TEST_P(ProcessesTest, AChildOpensADeviceOfItsOwnAndLeavesTheParentsAlone) {
    accel().push(test::square(0));
    for (int i = 0; i < 2; ++i) ASSERT_EQ(closest(test::down(0.5f, 0.5f)).t, 10);
    enum : int { right = 42, no_error, other_error, not_found };
    const int status = status_of_child([&]() -> int {
        for (const auto& action : std::vector<std::function<void()>>{
                 [&] { closest(test::down(0.5f, 0.5f)); }, [&] { Buffer(context(), {.name = "b", .bytes = 4}); },
                 [&] { context().wait_for_gpu(); }, [&] { accel().push(test::square(1)), accel().sync(); }}) {
            const std::string error = test::error_if_any(action);
            if (error.empty()) return no_error;
            if (error.find("fork") == error.npos || error.find("spawn") == error.npos) return other_error;
        }
        TearDown();
        SetUp();
        accel().push(test::square(-5));
        return closest(test::down(0.5f, 0.5f)).t == 15 ? right : not_found;
    });
    EXPECT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status) << (WTERMSIG(status) == SIGALRM ? ": hangs" : "");
    EXPECT_EQ(WEXITSTATUS(status), right);
    EXPECT_EQ(closest(test::down(0.5f, 0.5f)).t, 10) << "in the parent";
}

// Returns whether the action is interrupted.
template <class Action>
bool is_interrupted(const Action& action) {
    try {
        action();
    } catch (const Interrupted&) {
        return true;
    }
    return false;
}

TEST_P(ProcessesTest, ACallEndsWhereItsCallerWantsThatAndTheNextIsRight) {
    accel().push(make_icosphere(5));
    const std::vector<Ray> rays(1 << 16, Ray{vec3(0, 0, 10), 0, vec3(0, 0, -1), INFINITY});
    const auto trace = [&] { return accel().closest_hits(rays).back().t; };
    {
        const InterruptScope never([] { return false; });
        EXPECT_TRUE(is_interrupted(trace)) << "while it builds";
        const InterruptScope inner([] { return true; });
        EXPECT_FALSE(is_interrupted(trace)) << "the innermost scope is asked";
    }
    const float t = trace();
    EXPECT_NEAR(t, 9, 0.01);
    int looks = 0;
    {
        const InterruptScope thrice([&] { return ++looks < 3; });
        EXPECT_TRUE(is_interrupted([&] {
            for (;;) trace();
        }));
    }
    EXPECT_EQ(looks, 3);
    EXPECT_EQ(trace(), t);
    const InterruptScope never([] { return false; });
    TearDown();  // waits all the same
}

TEST(Interruption, LoopsOnAllCoresLookOnTheThreadOfTheirCaller) {
    int looks = 0;
    const InterruptScope scope([&] { return ++looks < 2; });
    const auto caller = std::this_thread::get_id();
    bool was_asked_elsewhere = false;
    EXPECT_TRUE(is_interrupted([&] {
        for (;;)
            parallel_for(
                64,
                [&](std::size_t, std::size_t) {
                    if (std::this_thread::get_id() != caller) was_asked_elsewhere |= is_interruptible();
                },
                2);
    }));
    EXPECT_FALSE(was_asked_elsewhere);
}

INSTANTIATE_TEST_SUITE_P(, ProcessesTest,
                         ::testing::Values(test::Kind::software, test::Kind::ray_query, test::Kind::pipeline),
                         test::name_of_kind);

using FullDisk = test::VulkanTest;

TEST_F(FullDisk, AFailedSaveLeavesTheOldFileAndNoOther) {
    SwTlas accel(context());
    accel.push(make_icosphere(4));
    context().wait(accel.sync());
    const test::TempDir folder;
    const std::filesystem::path file = folder.write("scene.swtlas", "old");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{20'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string what = test::error_of([&] { accel.save(file); });
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    test::expect_contains(what, "scene.swtlas': cannot be written: File too large");
    EXPECT_EQ(read_file(file), (Bytes{'o', 'l', 'd'}));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}), 1);
    accel.save(file);
    EXPECT_EQ(SwTlas::load(context(), file).handles.size(), 1u);
}

}  // namespace
}  // namespace twinray
