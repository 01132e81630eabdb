// Bottom levels move into less memory. Not every driver asks for more than it needs (lavapipe does not); here it seems
// to.
#include "engine/core/error.h"
#include "engine/core/context.h"
#include <twinray/tlas.h>
#include "tests/support/caller.h"
#include "tests/support/device.h"
#include "report/faults/fault_injection.h"

namespace twinray {
namespace {

constexpr std::uint64_t structure_slack = 4097;

class Compaction : public test::VulkanTest {
  protected:
    ContextDesc context_desc() const override { return {.get_instance_proc_addr = driver_.entry()}; }
    void prepare() override {
        if (!missing_for_hardware(context().properties()).empty())
            TWINRAY_LACKS("ray_tracing", context().properties().name);
        driver_.set_structure_slack(structure_slack);
        accel_ = &keep<HwTlas>(context());
    }
    HwTlas& accel() { return *accel_; }
    // Wipes freed memory, so that nothing is found there any more.
    void wipe_freed_memory() {
        context().wait_for_gpu();
        std::vector<Buffer> wiped;
        for (int i = 0; i < 64; ++i)
            wiped.emplace_back(context(), BufferDesc{.name = "wiped", .bytes = structure_slack});
        context().wait(test::submit_pass(context(), "wipe", [&](Commands& commands) {
            for (const Buffer& buffer : wiped) commands.fill(buffer, 0, structure_slack / 4 * 4, 0);
        }));
    }
    void sync_and_wait() { context().wait(accel().sync()); }
    float t_at(float x) {
        const Ray ray{vec3(x + 0.5f, 0.25f, 10), 0, vec3(0, 0, -1), INFINITY};
        return accel().closest_hits(std::span(&ray, 1)).front().t;
    }
    AccelHandle push_box(float x) { return accel().push(make_box(vec3(x, 0, 0), vec3(x + 1, 1, 1))); }

  private:
    faults::FaultInjector driver_;
    HwTlas* accel_ = nullptr;
};

TEST_F(Compaction, HappensWhenAskedForAndKeepsViewsAndHits) {
    for (const float x : {0.0f, 2.0f, 4.0f}) push_box(x);
    accel().push(Mesh{});
    EXPECT_FALSE(accel().compact()) << "not built yet";
    sync_and_wait();
    const AccelView view = accel().view();
    const std::uint64_t bytes = accel().memory_usage().structures();
    sync_and_wait();
    EXPECT_EQ(accel().memory_usage().structures(), bytes) << "a clean sync does nothing";
    EXPECT_TRUE(accel().compact());
    sync_and_wait();
    EXPECT_LE(accel().memory_usage().structures(), bytes - 3 * structure_slack)
        << "a driver may make them smaller still";
    EXPECT_EQ(accel().revision(), view.revision);
    EXPECT_EQ(accel().view().scene, view.scene);
    wipe_freed_memory();
    for (const float x : {0.0f, 2.0f, 4.0f}) EXPECT_EQ(t_at(x), 9.0f);
    EXPECT_FALSE(accel().compact()) << "once";
}

TEST_F(Compaction, HappensInASyncThatHasOtherWork) {
    push_box(0);
    push_box(2);
    sync_and_wait();
    const std::uint64_t bytes = accel().memory_usage().structures();
    const AccelHandle third = push_box(4);
    sync_and_wait();
    EXPECT_LT(accel().memory_usage().structures(), bytes + structure_slack);
    accel().update_transform(third, Transform::translation({0, 0, 1}));
    sync_and_wait();
    EXPECT_FALSE(accel().compact());
    EXPECT_EQ(t_at(0), 9.0f);
    EXPECT_EQ(t_at(2), 9.0f);
    EXPECT_EQ(t_at(4), 8.0f);
}

TEST_F(Compaction, NeverWaitsForTheBuild) {
    test::Caller caller(context());
    context().wait_before_next_submission(caller.begin().done);
    push_box(0);
    accel().sync();
    EXPECT_FALSE(accel().compact());
    caller.signal();
    context().wait_for_gpu();
    EXPECT_TRUE(accel().compact());
}

TEST_F(Compaction, IsNotForgottenBySyncsOfOtherMeshes) {
    test::Caller caller(context());
    context().wait_before_next_submission(caller.begin().done);
    push_box(0);
    accel().sync();
    push_box(2);
    accel().sync();  // the GPU has built neither
    caller.signal();
    context().wait_for_gpu();
    const std::uint64_t bytes = accel().memory_usage().structures();
    EXPECT_TRUE(accel().compact());
    sync_and_wait();
    EXPECT_LE(accel().memory_usage().structures(), bytes - 2 * structure_slack);
    EXPECT_EQ(t_at(0), 9.0f);
    EXPECT_EQ(t_at(2), 9.0f);
}

TEST_F(Compaction, LeavesMeshesAloneWhoseVerticesMove) {
    const AccelHandle moving = push_box(0);
    sync_and_wait();
    accel().update_vertices(moving, make_box(vec3(0), vec3(1, 1, 2)).positions);
    sync_and_wait();
    EXPECT_FALSE(accel().compact());
    EXPECT_EQ(t_at(0), 8.0f);
    // A compacted one may also be moved.
    const AccelHandle late = push_box(2);
    sync_and_wait();
    EXPECT_TRUE(accel().compact());
    sync_and_wait();
    accel().update_vertices(late, make_box(vec3(2, 0, 0), vec3(3, 1, 3)).positions);
    EXPECT_EQ(t_at(2), 7.0f);
}

TEST_F(Compaction, FreesWhatItReplaces) {
    accel().sync();
    context().wait_for_gpu();
    const std::uint64_t before = context().allocated_bytes();
    const AccelHandle box = push_box(0);
    sync_and_wait();
    EXPECT_TRUE(accel().compact());
    sync_and_wait();
    accel().erase(box);
    accel().sync();
    context().wait_for_gpu();
    EXPECT_EQ(context().allocated_bytes(), before);
}

}  // namespace
}  // namespace twinray
