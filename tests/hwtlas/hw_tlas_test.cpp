// SPDX-License-Identifier: MIT
// HwTlas by every way of tracing, updates and rebuilds of the driver's structure, and launches of its pipeline.
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

// Right triangles in the planes z = 0, 1, 2 ...
Mesh layers(uint count) {
    Mesh mesh;
    mesh.name = "layers";
    for (uint i = 0; i < count; ++i) {
        const float z = static_cast<float>(i);
        mesh.positions.insert(mesh.positions.end(), {vec3(0, 0, z), vec3(1, 0, z), vec3(0, 1, z)});
        mesh.triangles.push_back(uvec3(3 * i, 3 * i + 1, 3 * i + 2));
    }
    return mesh;
}

Ray down_from(float z, float t_min = 0, float t_max = INFINITY) {
    return {vec3(0.25f, 0.5f, z), t_min, vec3(0, 0, -4), t_max};
}

TEST_P(HwTlasTest, TellsItsTracePath) {
    EXPECT_STREQ(accel().trace_path(), GetParam().use_ray_query ? "ray query" : "ray tracing pipeline");
    EXPECT_EQ(accel().reorders(), GetParam().order == BuildOrder::morton);
}

TEST_P(HwTlasTest, FillsEveryFieldOfAHit) {
    accel().push(layers(1), Transform{}, {.custom_index = 7});
    for (const Hit& hit : {closest(down_from(2)), any(down_from(2))}) {
        EXPECT_EQ(hit.hit, 1u);
        EXPECT_EQ(hit.t, 0.5f);
        EXPECT_EQ(hit.primitive_index, 0u);
        EXPECT_EQ(hit.custom_index, 7u);
        EXPECT_EQ(hit.u, 0.25f);
        EXPECT_EQ(hit.v, 0.5f);
        EXPECT_EQ(hit.instance_index, 0u);
        EXPECT_EQ(hit.flags, HIT_FRONT);
    }
    const Ray beside{vec3(0.75f, 0.75f, 2), 0, vec3(0, 0, -4), INFINITY};
    EXPECT_TRUE(same_bytes(closest(beside), miss()));
    EXPECT_TRUE(same_bytes(any(beside), miss()));
}

TEST_P(HwTlasTest, FindsTheNearestOfSeveralFromBothSides) {
    accel().push(layers(5));
    EXPECT_EQ(closest(down_from(8)).primitive_index, 4u);
    EXPECT_EQ(closest(down_from(8)).t, 1.0f);
    const Hit from_below = closest({vec3(0.25f, 0.5f, -1), 0, vec3(0, 0, 1), INFINITY});
    EXPECT_EQ(from_below.primitive_index, 0u);
    EXPECT_EQ(from_below.t, 1.0f);
}

TEST_P(HwTlasTest, TakesTheIntervalAsOpenAndANegativeStartAsZero) {
    accel().push(layers(2));
    EXPECT_EQ(closest(down_from(5, 1)).primitive_index, 0u);
    EXPECT_EQ(closest(down_from(5, 0.5f, 1)).hit, 0u);
    EXPECT_EQ(closest(down_from(5, 0.5f, 1.001f)).t, 1.0f);
    EXPECT_EQ(closest(down_from(5, 1, 1.25f)).hit, 0u);
    EXPECT_EQ(any(down_from(5, 1, 1.25f)).hit, 0u);
    EXPECT_EQ(any(down_from(5, 1)).primitive_index, 0u);
    EXPECT_EQ(closest(down_from(5, -100)).primitive_index, 1u);
    EXPECT_EQ(closest(down_from(0.5f, -100)).primitive_index, 0u);
    EXPECT_EQ(closest(down_from(-1, -100)).hit, 0u);
}

TEST_P(HwTlasTest, MissesWithRaysThatVulkanForbids) {
    accel().push(layers(1));
    Ray bad[10];
    std::fill(std::begin(bad), std::end(bad), down_from(2));
    bad[0].origin.x = NAN;
    bad[1].origin.z = INFINITY;
    bad[2].direction.y = NAN;
    bad[3].direction.z = -INFINITY;
    bad[4].direction = vec3(0);
    bad[5].t_min = NAN;
    bad[6].t_max = NAN;
    bad[7].t_min = 2, bad[7].t_max = 1;
    bad[8].t_min = -2, bad[8].t_max = -1;
    bad[9].t_min = INFINITY;
    for (const Hit& hit : accel().closest_hits(bad)) EXPECT_TRUE(same_bytes(hit, miss()));
    for (const Hit& hit : accel().any_hits(bad)) EXPECT_TRUE(same_bytes(hit, miss()));
}

TEST_P(HwTlasTest, ShowsInstancesOnlyToRaysThatShareABitOfTheMask) {
    const InstanceOptions options[] = {{.mask = 0x01}, {.mask = 0x82}, {.mask = 0}};
    const Transform transforms[] = {{}, Transform::translation(vec3(0, 0, 1)), Transform::translation(vec3(0, 0, 2))};
    accel().push(layers(1), transforms, options);
    accel().sync();
    const Ray ray = down_from(5);
    const Buffer rays(context(), {.name = "rays", .bytes = sizeof(Ray)});
    const Buffer hits(context(), {.name = "hits", .bytes = 4 * sizeof(Hit)});
    const std::uint8_t masks[] = {0x01, 0x80, 0xff, 0x7c};
    Commands commands(context(), "masks");
    {
        const auto pass = commands.pass("upload");
        commands.upload(rays, std::span(&ray, 1));
    }
    for (std::size_t i = 0; i < 4; ++i)
        accel().trace(commands, accel().view(),
                      {.rays = rays.ref<Ray>(), .hits = hits.ref<Hit>(i * sizeof(Hit)), .count = 1, .mask = masks[i]});
    commands.submit();
    const std::vector<Hit> found = download<Hit>(context(), hits, 4);
    EXPECT_EQ(found[0].t, 1.25f);
    EXPECT_EQ(found[1].t, 1.0f);
    EXPECT_EQ(found[1].instance_index, 1u);
    EXPECT_EQ(found[2].t, 1.0f);
    EXPECT_EQ(found[3].hit, 0u);
}

TEST_P(HwTlasTest, ReturnsTheSmallestAndTheLargestCustomIndex) {
    accel().push(layers(1), Transform::translation(vec3(0, 0, 1)), {.custom_index = 0});
    accel().push(layers(1), Transform::translation(vec3(0, 0, 3)), {.custom_index = max_custom_index});
    EXPECT_EQ(closest(down_from(2)).custom_index, 0u);
    EXPECT_EQ(closest(down_from(2)).instance_index, 0u);
    EXPECT_EQ(closest(down_from(4)).custom_index, max_custom_index);
    EXPECT_EQ(any(down_from(4)).hit, 1u);
}

TEST_P(HwTlasTest, GivesEachOf300000RaysItsOwnAnswer) {
    accel().push(layers(1));
    std::vector<Ray> rays(300000);
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i] = {vec3(0.25f, 0.25f, static_cast<float>(i)), 0, vec3(0, 0, i % 3 ? -1.0f : 1.0f), INFINITY};
    const std::vector<Hit> hits = accel().closest_hits(rays);
    for (std::size_t i = 1; i < rays.size(); ++i)
        ASSERT_EQ(hits[i].t, i % 3 ? static_cast<float>(i) : -1.0f) << "ray " << i;
}

TEST_P(HwTlasTest, BuildsWhatChangedBetweenTwoSyncs) {
    const AccelHandle first = accel().push(layers(1));
    const AccelHandle second = accel().push(layers(3), Transform::translation(vec3(5, 0, 0)));
    const Ray at_second{vec3(5.25f, 0.25f, 9), 0, vec3(0, 0, -1), INFINITY};
    EXPECT_EQ(closest(down_from(2)).hit, 1u);
    EXPECT_EQ(closest(at_second).instance_index, 1u);
    const std::uint64_t revision = accel().revision(), value = accel().sync().value;
    EXPECT_EQ(accel().sync().value, value);
    EXPECT_EQ(accel().revision(), revision);

    accel().update_transform(first, Transform::translation(vec3(0, 0, 1)));
    accel().update_transform(second, Transform::translation(vec3(-5, 0, 0)));
    EXPECT_EQ(closest(down_from(2)).t, 0.25f);
    EXPECT_EQ(closest(at_second).hit, 0u);
    accel().update_transform(second, Transform::translation(vec3(5, 0, 0)));
    EXPECT_TRUE(accel().erase(first));
    accel().push(layers(2), Transform::translation(vec3(0, 0, -4)));
    EXPECT_EQ(closest(at_second).instance_index, 0u);
    EXPECT_EQ(closest(at_second).primitive_index, 2u);
    EXPECT_EQ(closest(down_from(1)).instance_index, 1u);
    EXPECT_EQ(closest(down_from(1)).t, 1.0f);
}

TEST_P(HwTlasTest, CanBeEmptyBeforeAndAfterUse) {
    EXPECT_TRUE(same_bytes(closest(down_from(2)), miss()));
    const AccelHandle handle = accel().push(layers(1));
    EXPECT_EQ(closest(down_from(2)).hit, 1u);
    EXPECT_TRUE(accel().erase(handle));
    EXPECT_TRUE(same_bytes(closest(down_from(2)), miss()));
    EXPECT_TRUE(same_bytes(any(down_from(2)), miss()));
    EXPECT_TRUE(accel().closest_hits({}).empty());
}

TEST_P(HwTlasTest, RefusesAStaleAndAForeignView) {
    accel().push(layers(1));
    accel().sync();
    const AccelView view = accel().view();
    accel().push(layers(1));
    EXPECT_NE(error_if_any([&] { accel().view(); }).find("call sync() first"), std::string::npos);
    accel().sync();
    const Buffer memory(context(), {.name = "memory", .bytes = 64});
    const TraceDesc desc{.rays = memory.ref<Ray>(), .hits = memory.ref<Hit>(32), .count = 1};
    HwTlas other(context(), GetParam().order);
    Commands commands(context(), "stale");
    EXPECT_NE(error_if_any([&] { accel().trace(commands, view, desc); }).find("stale view"), std::string::npos);
    EXPECT_NE(error_if_any([&] { other.trace(commands, accel().view(), desc); }).find("another accelerator"),
              std::string::npos);
}

class HwTlasWithoutHardware : public VulkanTest {
  protected:
    ContextDesc context_desc() const override {
        ContextDesc desc;
        desc.use_ray_query = desc.use_ray_tracing_pipeline = false;
        return desc;
    }
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

// As on a device whose limit is far below the number of rays, traces are split.
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
