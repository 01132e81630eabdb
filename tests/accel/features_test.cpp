// SPDX-License-Identifier: MIT
// Programs that leave out what a trace does not need: the same hits, bit for bit, as the one that leaves out nothing.
#include <cstring>
#include <random>

#include "engine/verify/aimed_rays.h"
#include "tests/accel/accel_fixture.h"
#include "test_program.trace_program.h"

namespace twinray {
namespace {

class Features : public test::VulkanTest, public ::testing::WithParamInterface<std::tuple<Layout, Level>> {
  protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        if (SwTlas::capability_on(context().facts(), feature_of(level())).support == Support::unsupported)
            TWINRAY_LACKS("float64", "no float64");
        accel_ = std::make_unique<SwTlas>(
            context(),
            AccelOptions{.level = std::max(level(), Level::watertight), .layout = layout(), .can_move = false});
    }
    void TearDown() override {
        accel_.reset();
        VulkanTest::TearDown();
    }
    SwTlas& accel() { return *accel_; }
    static Layout layout() { return std::get<0>(GetParam()); }
    static Level level() { return std::get<1>(GetParam()); }
    static uint of_layout() { return layout() == Layout::bvh2 ? FEATURE_BVH2 : FEATURE_COMPRESSED; }

    uint features_for(const TraceDesc& desc) {
        accel().sync();
        return accel().features_for(desc);
    }
    // Traced by a program with what features_for() says, and by one with all.
    void expect_equal(std::span<const Ray> rays, TraceDesc desc = {}) {
        desc.level = level();
        const auto lean = accel().make_program(test_program, features_for(desc));
        ASSERT_EQ(lean->features(), features_for(desc));
        const auto general = accel().make_program(test_program, FEATURES_ALL);
        ASSERT_EQ(general->features(), FEATURES_ALL);
        std::size_t hits = 0;
        for (const bool is_any : {false, true}) {
            const auto trace = [&](const TraceProgram& program) {
                desc.program = &program;
                return is_any ? accel().any_hits(rays, desc) : accel().closest_hits(rays, desc);
            };
            const std::vector<Hit> leaner = trace(*lean), all = trace(*general);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(std::memcmp(&leaner[i], &all[i], sizeof(Hit)), 0) << "ray " << i << ", any " << is_any;
                hits += all[i].hit;
            }
        }
        EXPECT_GT(hits, rays.size() / 50);
    }

  private:
    std::unique_ptr<SwTlas> accel_;
};

std::string name_of_features(const ::testing::TestParamInfo<std::tuple<Layout, Level>>& info) {
    const char* names[] = {"_fast", "_watertight", "_refined", "_certified"};
    return std::string(name_of(std::get<0>(info.param))) + names[static_cast<std::size_t>(std::get<1>(info.param))];
}
INSTANTIATE_TEST_SUITE_P(Every, Features,
                         ::testing::Combine(::testing::Values(Layout::compressed4, Layout::bvh2),
                                            ::testing::Values(Level::fast, Level::watertight, Level::refined,
                                                              Level::certified)),
                         name_of_features);

// Random ones, and others along axes and within planes, with zeros of both signs.
std::vector<Ray> rays_with_zeros() {
    std::vector<Ray> rays = random_rays({vec3(-1.5f), vec3(1.5f)}, 6000, 4);
    std::mt19937 random(5);
    for (std::size_t i = 0; i < rays.size(); i += 2) {
        vec3& direction = rays[i].direction;
        const auto kept = static_cast<int>(random() % 3);
        for (int axis = 0; axis < 3; ++axis) {
            const float zero = random() % 2 ? 0.0f : -0.0f;
            if (axis != kept && random() % 4) direction[axis] = zero;
            if (random() % 4 == 0) rays[i].origin[axis] = zero;
        }
        if (direction[kept] == 0) direction[kept] = -1;
    }
    return rays;
}

TEST_P(Features, OneInstanceWhereItsMeshWasGiven) {
    accel().push(make_icosphere(4), Transform{}, {.custom_index = 7, .mask = 6});
    const uint least = of_layout() | FEATURE_HITS;
    EXPECT_EQ(features_for({}), least);
    EXPECT_EQ(features_for({.mask = 2}), least);
    EXPECT_EQ(features_for({.mask = 1}), least | FEATURE_MASKS);
    EXPECT_EQ(features_for({.cull = Cull::back}), least | FEATURE_CULLING);
    EXPECT_EQ(accel().view().features, least | FEATURE_MASKS | FEATURE_CULLING) << "kernels may ask for anything";
    expect_equal(rays_with_zeros());
    expect_equal(rays_with_zeros(), {.mask = 2});
    expect_equal(rays_with_zeros(), {.cull = Cull::front});
}

TEST_P(Features, SeveralInstancesWhereTheirMeshesWereGiven) {
    accel().push(make_icosphere(3), Transform{}, {.mask = 3});
    accel().push(make_soup(300, 3, 0.3f), Transform{}, {.mask = 2, .turned = true});
    accel().push(make_grid(8, 8), Transform{}, {.mask = 6, .no_culling = true});
    const uint least = of_layout() | FEATURE_INSTANCES | FEATURE_HITS;
    EXPECT_EQ(features_for({}), least) << "all have bit 1";
    EXPECT_EQ(features_for({.mask = 5}), least | FEATURE_MASKS);
    EXPECT_EQ(features_for({.mask = 2}), least);
    expect_equal(rays_with_zeros());
    expect_equal(rays_with_zeros(), {.mask = 5});
    expect_equal(rays_with_zeros(), {.mask = 2, .cull = Cull::back});
}

TEST_P(Features, InstancesElsewhere) {
    accel().push(make_icosphere(3));
    accel().push(make_icosphere(2), Transform::translation({0.7f, 0, 0.2f}) * Transform::scaling({1, 2, -1}));
    EXPECT_EQ(features_for({}), of_layout() | FEATURE_INSTANCES | FEATURE_TRANSFORMS | FEATURE_HITS);
    expect_equal(rays_with_zeros());
    expect_equal(rays_with_zeros(), {.cull = Cull::back});
}

TEST_P(Features, MeshesBuiltInAnotherUnitAreElsewhere) {
    Mesh tiny = make_icosphere(2);
    for (vec3& position : tiny.positions) position *= 0x1p-40f;
    accel().push(tiny);
    EXPECT_TRUE(features_for({}) & FEATURE_TRANSFORMS);
    const Ray ray{vec3(0, 0, 0x1p-38f), 0, vec3(0, 0, -1), INFINITY};
    EXPECT_EQ(accel().closest_hits(std::span(&ray, 1), {.level = level()})[0].hit, 1u);
}

TEST_P(Features, WhatMayMoveIsTransformedWhereverItStands) {
    SwTlas movable(context(), {.level = std::max(level(), Level::watertight), .layout = layout()});
    const AccelHandle handle = movable.push(test::square(0));
    const Ray ray = test::down(10.5f, 0.5f);
    EXPECT_EQ(movable.closest_hits(std::span(&ray, 1), {.level = level()})[0].hit, 0u);
    const AccelView view = movable.view();
    EXPECT_TRUE(view.features & FEATURE_TRANSFORMS);
    movable.update_transform(handle, Transform::translation({10, 0, 0}));
    EXPECT_EQ(movable.closest_hits(std::span(&ray, 1), {.level = level()})[0].hit, 1u);
    EXPECT_EQ(movable.revision(), view.revision) << "the view of before is as good";
}

TEST_P(Features, WhatMayNotMoveDoesNot) {
    const AccelHandle handle = accel().push(test::square(0));
    accel().sync();
    const Transform transform;
    const auto refused = [](const std::function<void()>& action) {
        return test::error_of(action).find("can_move = false") != std::string::npos;
    };
    EXPECT_TRUE(refused([&] { accel().update_transform(handle, transform); }));
    EXPECT_TRUE(refused([&] { accel().update_transform_at(handle, 0, transform); }));
    EXPECT_TRUE(refused([&] { accel().update_transforms(handle, std::span(&transform, 1)); }));
    EXPECT_TRUE(refused([&] { accel().update_transforms(handle, Ref<Transform>{64}, 1); }));
    EXPECT_TRUE(refused([&] { accel().mark_transforms_dirty(handle); }));
    EXPECT_EQ(accel().instance_buffer(handle).count, 1u) << "may be read";
}

// Whichever program serves, and however many have been compiled by then.
TEST_P(Features, ProgramsChangeInTheBackgroundAndHitsDoNot) {
    accel().push(make_icosphere(3), Transform{}, {.mask = 1});
    const std::vector<Ray> rays = rays_with_zeros();
    const TraceDesc descs[] = {{}, {.cull = Cull::back}, {.mask = 2}, {.mask = 2, .cull = Cull::back}};
    std::vector<std::vector<Hit>> first;
    for (int pass = 0; pass < 3; ++pass) {
        for (std::size_t i = 0; i < std::size(descs); ++i) {
            TraceDesc desc = descs[i];
            desc.level = level();
            const std::vector<Hit> hits = accel().closest_hits(rays, desc);
            if (pass == 0) first.push_back(hits);
            ASSERT_EQ(std::memcmp(hits.data(), first[i].data(), hits.size() * sizeof(Hit)), 0);
        }
        if (pass == 1) accel().wait_for_programs();
    }
}

TEST_P(Features, AnAnswerAloneIsThatOfTheWholeHit) {
    accel().push(make_icosphere(3));
    accel().sync();
    const std::vector<Ray> rays = rays_with_zeros();
    const std::vector<Hit> whole = accel().any_hits(rays, {.level = level()});
    const Buffer ray_buffer(context(), {.name = "rays", .bytes = std::span(rays).size_bytes()});
    const Buffer hits(context(), {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
    for (const bool is_waited_for : {false, true}) {
        if (is_waited_for) accel().wait_for_programs();
        Commands commands(context(), "answers");
        {
            const auto pass = commands.pass("rays");
            commands.upload(ray_buffer, std::span<const Ray>(rays));
        }
        accel().trace(commands, accel().view(),
                      {.rays = ray_buffer.ref<Ray>(),
                       .hits = hits.ref<Hit>(),
                       .count = rays.size(),
                       .query = Query::any,
                       .level = level(),
                       .answer_only = true});
        commands.submit();
        const std::vector<Hit> answers = download<Hit>(context(), hits, rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(answers[i].hit, whole[i].hit) << "ray " << i;
    }
}

}  // namespace
}  // namespace twinray
