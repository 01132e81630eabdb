// SPDX-License-Identifier: MIT
// The ways of tracing of HwTlas, updates and rebuilds of the driver's structure, and launches of its pipeline.
#include <twinray/tlas.h>

#include <twinray/geometry.h>
#include "engine/core/error.h"
#include "engine/core/ray.h"
#include "hwtlas/ray_tracing_pipeline.h"
#include "hwtlas_trace_rchit.spv.h"
#include "hwtlas_trace_rgen.spv.h"
#include "hwtlas_trace_rmiss.spv.h"
#include "tests/accel/accel_fixture.h"
#include "tests/hwtlas/hw_test.h"
#include "validation/reference/aimed_rays.h"

namespace twinray::test {
namespace {

INSTANTIATE_TEST_SUITE_P(Ways, HwTlasTest, all_ways, name_of_way);

TEST_P(HwTlasTest, TellsItsTracePath) {
    EXPECT_STREQ(accel().trace_path(), GetParam().use_ray_query ? "ray query" : "ray tracing pipeline");
    EXPECT_EQ(accel().reorders(), GetParam().order == BuildOrder::morton);
}

class HwTlasWithoutHardware : public VulkanTest {
  protected:
    ContextDesc context_desc() const override { return {.use_ray_query = false, .use_ray_tracing_pipeline = false}; }
};

TEST_F(HwTlasWithoutHardware, NamesTheDeviceAndWhatItLacks) {
    const std::string message = error_if_any([&] { HwTlas accel(context()); });
    EXPECT_NE(message.find(context().properties().name), std::string::npos) << message;
    EXPECT_NE(message.find("VK_KHR_ray_query or VK_KHR_ray_tracing_pipeline"), std::string::npos) << message;
}

// Instances come and go between moves: the driver's structure is rebuilt then, and updated where they only move.
using InstanceCountTest = HwTlasTest;
INSTANTIATE_TEST_SUITE_P(Ways, InstanceCountTest, all_ways, name_of_way);

// Squares that face up, one at each whole x.
class Row {
  public:
    explicit Row(HwTlas& accel) : accel_(accel) {}

    void push() { squares_.push_back({accel_.push(make_quad(vec3(0), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0))), 0}); }
    void erase_first() {
        EXPECT_TRUE(accel_.erase(squares_.front().handle));
        squares_.erase(squares_.begin());
    }
    void move(float z) {
        if (accel_.compact()) accel_.sync();  // or it would come with the move, and rebuild
        for (std::size_t i = 0; i < squares_.size(); ++i) {
            squares_[i].z = z + static_cast<float>(i);
            accel_.update_transform(squares_[i].handle,
                                    Transform::translation(vec3(static_cast<float>(i), 0, squares_[i].z)));
        }
    }
    void check() {
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < squares_.size() + 1; ++i)
            rays.push_back({vec3(static_cast<float>(i) + 0.125f, 0.25f, 100), 0, vec3(0, 0, -1), INFINITY});
        const std::vector<Hit> hits = accel_.closest_hits(rays);
        for (std::size_t i = 0; i < squares_.size(); ++i) {
            EXPECT_FLOAT_EQ(hits[i].t, 100 - squares_[i].z) << i << " of " << squares_.size();
            EXPECT_EQ(hits[i].instance_index, i);
        }
        EXPECT_EQ(hits.back().hit, 0u);
    }
    ::testing::AssertionResult was_updated() const {
        std::string passes;
        for (const PassTiming& pass : accel_.build_timings()) {
            if (pass.name == "hwtlas_update_tlas") return ::testing::AssertionSuccess();
            passes += ' ' + pass.name;
        }
        return ::testing::AssertionFailure() << "passes of the build:" << passes;
    }

  private:
    struct Square {
        AccelHandle handle;
        float z;
    };
    HwTlas& accel_;
    std::vector<Square> squares_;
};

TEST_P(InstanceCountTest, EachChangeOfItRebuilds) {
    if (context().state().timestamp_period_ns() == 0) TWINRAY_LACKS("ray_tracing", "passes are told by their times");
    Row row(accel());
    for (int i = 0; i < 3; ++i) row.push();
    row.move(0), row.check();
    row.move(1), row.check();
    row.move(2), row.check();
    EXPECT_TRUE(row.was_updated());
    for (int round = 0; round < 3; ++round) {
        row.push(), row.push(), row.move(3), row.check();
        EXPECT_FALSE(row.was_updated()) << "two more";
        row.move(4), row.check();
        EXPECT_TRUE(row.was_updated());
        row.erase_first(), row.move(5), row.check();
        EXPECT_FALSE(row.was_updated()) << "one less";
        row.erase_first(), row.push(), row.move(6), row.check();
        EXPECT_FALSE(row.was_updated()) << "as many, but another";
        row.move(7), row.check();
        EXPECT_TRUE(row.was_updated());
    }
}

using PipelineLaunch = AccelTest;
INSTANTIATE_TEST_SUITE_P(Every, PipelineLaunch, ::testing::Values(Kind::pipeline), name_of_kind);

// Traces are split as on a device whose limit is far below the number of rays.
TEST_P(PipelineLaunch, SeveralLaunchesGiveWhatOneGives) {
    accel().push(make_icosphere(3));
    const std::vector<Ray> rays = twinray::random_rays({vec3(-2), vec3(2)}, 100'001, 3);
    const std::vector<Hit> expected = accel().closest_hits(rays);
    const AccelView view = accel().view();
    const RayTracingPipeline pipeline(context(), {.name = "limited",
                                                  .ray_generation = hwtlas_trace_rgen_spirv,
                                                  .miss = hwtlas_trace_rmiss_spirv,
                                                  .closest_hit = hwtlas_trace_rchit_spirv,
                                                  .any_hit = {},
                                                  .intersection = {},
                                                  .constants = {{FEATURES_CONSTANT, view.features}},
                                                  .launch_limit = 40'000});
    const Buffer source = device_copy(rays), hits(context(), {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
    Commands commands(context(), "limited");
    pipeline.trace(commands, {view.scene, source.ref<Ray>(), hits.ref<Hit>(), {}, 0, {}, 100'001, 0xff, 0, 0});
    commands.submit();
    const std::vector<Hit> found = download<Hit>(context(), hits, rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(std::memcmp(&found[i], &expected[i], sizeof(Hit)), 0) << "ray " << i;
}

}  // namespace
}  // namespace twinray::test
