// Programs that leave out what a trace does not need: their hits are, bit for bit, those of the program that leaves out
// nothing.
#include "engine/accel/trace_desc.h"
#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"
#include "test_program.trace_program.h"

namespace twinray {
namespace {

// Returns random rays, and others along axes and within planes, with zeros of both signs.
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

class Features : public test::VulkanTest, public ::testing::WithParamInterface<test::LayoutAndLevel> {
  protected:
    void prepare() override {
        if (!test::has_level(context(), level())) TWINRAY_LACKS("float64", "no float64");
        accel_ = &keep<SwTlas>(
            context(),
            AccelOptions{.level = std::max(level(), Level::watertight), .layout = layout(), .can_move = false});
    }
    SwTlas& accel() { return *accel_; }
    static Layout layout() { return std::get<0>(GetParam()); }
    static Level level() { return std::get<1>(GetParam()); }
    static uint of_layout() { return feature_of_layout(layout()); }

    uint features_for(const TraceDesc& desc) {
        accel().sync();
        return accel().features_for(desc);
    }
    // Expects equal hits from a program with the features of features_for() and from one with all.
    void expect_equal(TraceDesc desc = {}) {
        desc.level = level();
        const uint needed = features_for(desc);
        const TraceProgram &lean = program(needed), &general = program(FEATURES_ALL);
        ASSERT_EQ(lean.features(), needed);
        const std::vector<Ray> rays = rays_with_zeros();
        std::size_t hits = 0;
        for (const bool is_any : {false, true}) {
            const auto trace = [&](const TraceProgram& program) {
                desc.program = &program;
                return is_any ? accel().any_hits(rays, desc) : accel().closest_hits(rays, desc);
            };
            const std::vector<Hit> leaner = trace(lean), all = trace(general);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_TRUE(is_same(leaner[i], all[i])) << "ray " << i << ", any " << is_any << ", features " << needed;
                hits += all[i].hit;
            }
        }
        EXPECT_GT(hits, rays.size() / 50);
        expect_equal_answers(rays, desc);
    }

    // Expects equal answers to rays that only ask whether there is a hit, some of which end at their closest hit: from
    // the program that serves until the one without needless features is compiled, and from that one.
    void expect_equal_answers(std::vector<Ray> rays, TraceDesc desc) {
        desc.program = nullptr;
        desc.level = level();
        const std::vector<Hit> closest = accel().closest_hits(rays, desc);
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (closest[i].hit && i % 3 != 0) (i % 3 == 1 ? rays[i].t_min : rays[i].t_max) = closest[i].t;
        const std::vector<Hit> whole = accel().any_hits(rays, desc);
        accel().any_hits(rays, desc);  // from the second on the general program is there
        accel().wait_for_programs();
        for (const bool is_waited_for : {false, true}) {
            if (is_waited_for) accel().wait_for_programs();
            desc.query = Query::any;
            desc.occlusion_only = true;
            const std::vector<Hit> answers = test::traced(accel(), accel().view(), rays, desc);
            for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(answers[i].hit, whole[i].hit) << "ray " << i;
        }
    }

  private:
    // Compares to the last bit; at level fast, whose arithmetic compilers may rearrange, signs of zeros may differ.
    static bool is_same(const Hit& a, const Hit& b) {
        if (level() != Level::fast) return std::memcmp(&a, &b, sizeof(Hit)) == 0;
        return a.hit == b.hit && a.primitive_index == b.primitive_index && a.instance_index == b.instance_index &&
               a.t == b.t && a.u == b.u && a.v == b.v;
    }
    const TraceProgram& program(uint features) {
        TraceProgram*& program = programs_[features];
        if (!program) program = keep<std::unique_ptr<TraceProgram>>(accel().make_program(test_program, features)).get();
        return *program;
    }

    SwTlas* accel_ = nullptr;
    std::map<uint, TraceProgram*> programs_;
};

INSTANTIATE_TEST_SUITE_P(Every, Features, ::testing::Combine(::testing::Values(Layout::compressed4), test::every_level),
                         test::name_of_layout_and_level);
INSTANTIATE_TEST_SUITE_P(Full, Features,
                         ::testing::Combine(::testing::Values(Layout::bvh2, Layout::compressed8), test::every_level),
                         test::name_of_layout_and_level);

TEST_P(Features, LeanProgramsFindWhatTheGeneralOneFinds) {
    const uint one = of_layout() | FEATURE_HITS, several = one | FEATURE_INSTANCES;
    const AccelHandle first = accel().push(make_icosphere(3), Transform{}, {.custom_index = 7, .mask = 6});
    EXPECT_EQ(features_for({.mask = 2}), one);
    EXPECT_EQ(features_for({.mask = 1}), one | FEATURE_MASKS);
    EXPECT_EQ(features_for({.cull = Cull::back}), one | FEATURE_CULLING);
    EXPECT_EQ(accel().view().features, one | FEATURE_MASKS | FEATURE_CULLING) << "kernels may ask for anything";
    expect_equal();
    expect_equal({.mask = 2});
    expect_equal({.cull = Cull::front});

    accel().push(make_soup(300, 3, 0.3f), Transform{}, {.mask = 3, .flip_facing = true});
    accel().push(make_grid(8, 8), Transform{}, {.mask = 2, .disable_culling = true});
    EXPECT_EQ(features_for({}), several) << "all have bit 1";
    EXPECT_EQ(features_for({.mask = 5}), several | FEATURE_MASKS);
    expect_equal();
    expect_equal({.mask = 5});
    expect_equal({.cull = Cull::back});

    accel().erase(first);
    accel().push(make_icosphere(2), Transform::translation({0.7f, 0, 0.2f}) * Transform::scaling({1, 2, -1}));
    EXPECT_EQ(features_for({}), several | FEATURE_TRANSFORMS);
    expect_equal();
}

class FeaturesOfAccel : public Features {};
INSTANTIATE_TEST_SUITE_P(Some, FeaturesOfAccel,
                         ::testing::Values(std::tuple(Layout::compressed4, Level::watertight),
                                           std::tuple(Layout::compressed8, Level::watertight),
                                           std::tuple(Layout::bvh2, Level::certified)),
                         test::name_of_layout_and_level);

TEST_P(FeaturesOfAccel, MeshesBuiltInAnotherUnitAreElsewhere) {
    Mesh tiny = make_icosphere(2);
    for (vec3& position : tiny.positions) position *= 0x1p-40f;
    accel().push(tiny);
    EXPECT_TRUE(features_for({}) & FEATURE_TRANSFORMS);
    const Ray ray{vec3(0, 0, 0x1p-38f), 0, vec3(0, 0, -1), INFINITY};
    EXPECT_EQ(accel().closest_hits(std::span(&ray, 1), {.level = level()})[0].hit, 1u);
}

TEST_P(FeaturesOfAccel, WhatMayMoveIsTransformedWhereverItStands) {
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

TEST_P(FeaturesOfAccel, WhatMayNotMoveDoesNot) {
    const AccelHandle handle = accel().push(test::square(0));
    accel().sync();
    const Transform transform;
    const auto refused = [](const char* name, const std::function<void()>& action) {
        test::expect_error(text(name, ": the accelerator was made with AccelOptions::can_move = false"), action);
    };
    refused(": update_transform", [&] { accel().update_transform(handle, transform); });
    refused(": update_transform_at", [&] { accel().update_transform_at(handle, 0, transform); });
    refused(": update_transforms", [&] { accel().update_transforms(handle, std::span(&transform, 1)); });
    refused(": update_transforms", [&] { accel().update_transforms(handle, Ref<Transform>{64}, 1); });
    refused(": mark_transforms_dirty", [&] { accel().mark_transforms_dirty(handle); });
    EXPECT_EQ(accel().instance_buffer(handle).count, 1u) << "may be read";
}

// Hits do not depend on which program serves, nor on how many have been compiled by then.
TEST_P(FeaturesOfAccel, ProgramsChangeInTheBackgroundAndHitsDoNot) {
    accel().push(make_icosphere(3), Transform{}, {.mask = 1});
    const std::vector<Ray> rays = rays_with_zeros();
    const TraceDesc descs[] = {{}, {.cull = Cull::back}, {.mask = 2}, {.mask = 2, .cull = Cull::back}};
    for (int i = 0; i < 2; ++i) accel().closest_hits(rays, {.level = level()});
    accel().wait_for_programs();  // the general one is there
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

TEST_P(FeaturesOfAccel, AnAnswerAloneIsThatOfTheWholeHit) {
    accel().push(make_icosphere(3));
    accel().sync();
    expect_equal_answers(rays_with_zeros(), {});
}

}  // namespace
}  // namespace twinray
