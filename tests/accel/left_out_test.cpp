// SPDX-License-Identifier: MIT
// A sync leaves out work that nobody needs, as its passes show.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/accel/world_bound.h"
#include "engine/core/context.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::square;

class LeftOut : public test::AccelTest {
  protected:
    // Returns the names of the passes of the last sync.
    std::vector<std::string> passes() {
        accel().wait_for_gpu();
        std::vector<std::string> names;
        for (const PassTiming& pass : accel().build_timings()) names.push_back(pass.name);
        EXPECT_FALSE(names.empty()) << "the device has no timestamps, which tell of passes";
        return names;
    }
    bool has_pass(const std::string& name) {
        const std::vector<std::string> names = passes();
        return std::ranges::find(names, name) != names.end();
    }
    void move(AccelHandle handle, float x) {
        accel().update_transform(handle, Transform::translation({x, 0, 0}));
        accel().sync();
    }
};
TWINRAY_OVER_EVERY_ACCEL(LeftOut);

TEST_P(LeftOut, TheBoundUntilSomebodyAsks) {
    const AccelHandle handle = accel().push(square(0));
    accel().sync();
    EXPECT_FALSE(has_pass("engine_world_bound"));
    EXPECT_EQ(accel().world_bound().hi, vec3(1, 1, 0)) << "it is computed for the sync that did without";
    for (const float x : {2.0f, 3.0f}) {
        move(handle, x);
        EXPECT_TRUE(has_pass("engine_world_bound")) << "who asked once asks again";
        EXPECT_EQ(accel().world_bound().hi, vec3(1 + x, 1, 0));
    }
}

TEST_P(LeftOut, TheBoundIsThereAfterTheFirstQuestionThatDoesNotWait) {
    accel().push(square(0));
    accel().sync();
    accel().wait_for_gpu();
    accel().world_bound_if_ready();
    accel().wait_for_gpu();
    ASSERT_TRUE(accel().world_bound_if_ready().has_value());
    EXPECT_EQ(accel().world_bound_if_ready()->hi, vec3(1, 1, 0));
}

// Kernels write after the sync, and nothing has changed before the next one.
TEST_P(LeftOut, TheBoundIsThatOfTheLastSync) {
    const AccelHandle handle = accel().push(square(0));
    accel().sync();
    write_instances(accel().instance_buffer(handle), 0, Transform::translation({0, 0, 7}));
    EXPECT_EQ(accel().world_bound().hi.z, 0.0f);
    accel().mark_transforms_dirty(handle);
    accel().sync();
    EXPECT_EQ(accel().world_bound().hi.z, 7.0f);
}

TEST_P(LeftOut, TheKernelThatGathersInstancesUntilAKernelHasWrittenTheOneThatThereIs) {
    const auto height = [&] { return 10.0f - closest(test::down(0.5f, 0.25f)).t; };
    const AccelHandle handle = accel().push(square(1));
    EXPECT_EQ(height(), 1.0f);
    EXPECT_FALSE(has_pass("hwtlas_gather_instances"));
    accel().update_transform(handle, Transform::translation({0, 0, 2}));
    EXPECT_EQ(height(), 3.0f) << "the host has moved it";
    EXPECT_FALSE(has_pass("hwtlas_gather_instances"));
    write_instances(accel().instance_buffer(handle), 0, Transform::translation({0, 0, 4}));
    accel().mark_transforms_dirty(handle);
    EXPECT_EQ(height(), 5.0f) << "a kernel has";
    EXPECT_EQ(has_pass("hwtlas_gather_instances"), !accel().is_software());
}

TEST_P(LeftOut, TheBoundUnlessAMeshOfOtherUnitsMakesATransformUnusable) {
    const AccelHandle handle = accel().push(square(0), Transform::scaling(vec3(1e20f)));
    accel().sync();
    Mesh large = square(0);
    for (vec3& point : large.positions) point *= 1e36f;
    accel().update(handle, large);
    accel().sync();
    accel().wait_for_gpu();
    accel().push(square(1));
    accel().sync();
    EXPECT_TRUE(was_logged("they are inactive"));
}

TEST_P(LeftOut, OneInstanceOfTwoAndTwoOfOne) {
    const Mesh mesh = make_icosphere(2);
    const auto turned = Transform{{vec4(0.6f, -0.8f, 0, 0), vec4(0.8f, 0.6f, 0, 0), vec4(0, 0, 1, 0)}};
    const AccelHandle first = accel().push(mesh, turned);
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(closest(test::down(0.1f, 0.2f)).instance_index, 0u);
        const AccelHandle second = accel().push(mesh, Transform::translation({0, 0, 3}));
        EXPECT_NEAR(closest(test::down(0.1f, 0.2f)).t, 6.0f, 0.1f);
        EXPECT_EQ(accel().handle_of(closest(test::down(0.1f, 0.2f))), second);
        accel().erase(second);
        EXPECT_NEAR(closest(test::down(0.1f, 0.2f)).t, 9.0f, 0.1f);
        EXPECT_EQ(accel().handle_of(closest(test::down(0.1f, 0.2f))), first);
    }
}

// A trace takes the bits of 1.0f, which are more than 3, as its count of rays.
TEST_P(LeftOut, TheBoundUntilAKernelReadsIt) {
    accel().push(square(5));
    accel().sync();
    const Buffer rays = device_copy(std::vector<Ray>(3, test::down(0.5f, 0.25f))),
                 hits = device_copy(std::vector<Hit>(3));
    Commands commands(context(), "count from the bound");
    accel().trace(commands, accel().view(),
                  {.rays = rays.ref<Ray>(),
                   .hits = hits.ref<Hit>(),
                   .count = 3,
                   .indirect_count = {accel().world_bound_on_device().address + offsetof(WorldBound, hi)}});
    commands.submit();
    EXPECT_EQ(download<Hit>(context(), hits, 3)[2].hit, 1u);
}

TEST_P(LeftOut, AreasUntilSomebodyAsks) {
    accel().push(make_icosphere(2));
    accel().push(make_icosphere(3), Transform::translation({1, 0, 0}));
    accel().sync();
    EXPECT_FALSE(has_pass("engine_join_areas"));
    if (!measures_its_trees()) return;
    const std::optional<double> built = accel().sah();
    ASSERT_TRUE(built.has_value());
    EXPECT_GT(*built, 0);
    EXPECT_EQ(accel().sah(), built) << "measured once";
}

// The accelerator leaves out the host's copy of a mesh, and refuses whatever would need it.
TEST_P(LeftOut, MeshesThatTheHostNeedNotKeep) {
    const Mesh mesh = make_icosphere(4);
    const auto bare = make_accel({.keeps_meshes = false, .compiles_in_background = false});
    const AccelHandle handle = bare->push(mesh);
    const std::uint64_t before = bare->memory_usage().host;
    bare->sync();
    const std::uint64_t copy = mesh.positions.size() * sizeof(vec3) + mesh.triangles.size() * sizeof(uvec3);
    EXPECT_GE(before, copy);
    EXPECT_LT(bare->memory_usage().host, 1000u) << "the record of an instance";
    const Ray ray = test::down(0.25f, 0.25f);
    const auto hit_of = [&](AbstractAccel& accel) { return accel.closest_hits({&ray, 1}).front(); };
    accel().push(mesh);
    EXPECT_EQ(hit_of(*bare), hit_of(accel()));
    const std::string why = "'icosphere' is no longer there: the accelerator was made with AccelOptions::keeps_meshes";
    for (const std::string& error : {test::error_if_any([&] { bare->update_vertices(handle, mesh.positions); }),
                                     test::error_if_any([&] { bare->update_vertices(handle, Floats{16}, 2562); }),
                                     test::error_if_any([&] { scene_of(*bare); })})
        EXPECT_NE(error.find(why), std::string::npos) << error;
    bare->update_transform(handle, Transform::translation({0, 0, 1}));
    EXPECT_NEAR(hit_of(*bare).t, hit_of(accel()).t - 1, 1e-5);
    bare->update(handle, make_icosphere(4, 2));
    EXPECT_LT(hit_of(*bare).t, hit_of(accel()).t - 1.9f);
    EXPECT_LT(bare->memory_usage().host, 1000u);
}

// Nothing is sorted, and only one of a tree's stages is left.
TEST_P(LeftOut, StagesOfTreesWithOneLeaf) {
    Mesh one;
    one.name = "one";
    one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    one.triangles = {{0, 1, 2}};
    const AccelHandle handle = accel().push(one);
    accel().sync();
    const std::vector<std::string> software = {"geometry sources",    "swtlas geometry input", "swtlas build input",
                                               "swtlas_lone_leaves",  "instance upload",       "swtlas scene input",
                                               "swtlas_lone_instance"};
    if (GetParam() == test::Kind::software) {
        EXPECT_EQ(passes(), software);
    }
    EXPECT_FALSE(has_pass("sort_histogram"));
    EXPECT_EQ(closest(test::down(0.25f, 0.25f)).hit, 1u);
    accel().update_transform(handle, Transform::translation({0, 0, 3}));
    accel().update_vertices(handle, std::vector<vec3>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}});
    accel().sync();
    if (GetParam() == test::Kind::software) {
        EXPECT_FALSE(has_pass("sort_histogram"));
    }
    EXPECT_EQ(closest(test::down(0.9f, 0.9f)).t, 7.0f) << "the leaf is as it is now";
}

}  // namespace
}  // namespace twinray
