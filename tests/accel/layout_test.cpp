// Layouts and build qualities of SwTlas, and both rows of KernelTuning: the same hits, bit for bit.
#include <twinray/queries.h>

#include "engine/accel/trace_desc.h"
#include "test_program.trace_program.h"
#include "tests/accel/accel_fixture.h"
#include "validation/reference/aimed_rays.h"

namespace twinray {
namespace {

class Layouts : public test::VulkanTest, public ::testing::WithParamInterface<Level> {
  protected:
    void prepare() override {
        if (!test::has_level(context(), GetParam())) TWINRAY_LACKS("float64", "no float64");
        for (const Layout layout : all_layouts)
            for (const BuildQuality quality : all_build_qualities)
                accels_.push_back(
                    &keep<SwTlas>(context(), AccelOptions{std::max(GetParam(), Level::watertight), layout, quality}));
    }
    void expect_equal(std::span<const Ray> rays, TraceDesc desc = {}) {
        desc.level = GetParam();
        std::vector<Hit> first;
        for (SwTlas* accel : accels_) {
            const auto program = accel->make_program(test_program);
            desc.program = program.get();
            const std::vector<Hit> closest = accel->closest_hits(rays, desc), any = accel->any_hits(rays, desc);
            if (first.empty()) first = closest;
            for (std::size_t r = 0; r < rays.size(); ++r) {
                ASSERT_EQ(std::memcmp(&closest[r], &first[r], sizeof(Hit)), 0) << "ray " << r;
                ASSERT_EQ(any[r].hit, first[r].hit);
            }
        }
        const auto hits = std::ranges::count(first, 1u, &Hit::hit);
        EXPECT_GT(static_cast<std::size_t>(hits), rays.size() / 50);
    }

    std::vector<SwTlas*> accels_;
};

INSTANTIATE_TEST_SUITE_P(Every, Layouts, test::every_level,
                         [](const auto& level) { return std::string(name_of(level.param)); });

// Pushes instances of every kind within a cube.
template <class MeshOf>
void push_sixty(SwTlas& accel, float extent, bool has_filters, const MeshOf& mesh_of) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (uint i = 0; i < 60; ++i) {
        const vec3 place = extent * vec3(unit(random), unit(random), unit(random));
        const vec3 size(unit(random), 0.7f, i % 5 ? 1 : -1e-3f);
        accel.push(
            mesh_of(i), Transform::translation(place) * Transform::scaling(size),
            {.custom_index = i, .mask = static_cast<std::uint8_t>(1 + i % 3), .non_opaque = has_filters && i % 7 == 0});
    }
}

TEST_P(Layouts, AgreeOnInstancesOfEveryKind) {
    const Mesh meshes[] = {make_icosphere(3), make_soup(500, 3, 0.2f), make_grid(8, 8), make_soup(1, 5)};
    for (SwTlas* accel : accels_) push_sixty(*accel, 3, true, [&](uint i) -> const Mesh& { return meshes[i % 4]; });
    const std::vector<Ray> rays = random_rays({vec3(-4), vec3(4)}, 20'000, 4);
    expect_equal(rays);
    expect_equal(rays, {.mask = 2});
    expect_equal(rays, {.cull = Cull::back});
    expect_equal(rays, {.cull = Cull::front});
}

// Boxes overlap on many levels: more entries wait than registers hold, below the top level and in it.
TEST_P(Layouts, AgreeWhereMuchWaits) {
    const Mesh soup = make_soup(3000, 7, 0.5f);
    const std::vector<Ray> rays = random_rays({vec3(-1), vec3(1)}, 2'000, 8);
    for (SwTlas* accel : accels_) accel->push(soup);
    expect_equal(rays);
    for (SwTlas* accel : accels_)
        for (int i = 1; i < 20; ++i) accel->push(soup, Transform::translation(vec3(0.05f * static_cast<float>(i))));
    expect_equal(rays);
}

// Rays run within planes of boxes, through corners, from far away, and along axes.
TEST_P(Layouts, AgreeWhereBoxesAreMetExactly) {
    const Mesh grid = make_grid(16, 16);
    for (SwTlas* accel : accels_) accel->push(grid, Transform::scaling({16, 16, 16}));
    std::mt19937 random(5);
    std::vector<Ray> rays;
    for (int i = 0; i < 20'000; ++i) {
        const auto whole = [&] { return static_cast<float>(random() % 17) - 8; };
        const vec3 target(whole(), 0, whole());
        const float far = i % 3 ? 1.0f : 1e5f;
        const vec3 direction(i % 2 ? 0.0f : whole(), -1, i % 5 ? 0.0f : whole());
        rays.push_back({target - far * direction, 0, direction, INFINITY});
    }
    expect_equal(rays);
}

// One instance needs no top level, and the kernel for it must not be used for more.
TEST_P(Layouts, InstancesMayComeAndGo) {
    const Ray rays[] = {test::down(0.3f, 0.6f), test::down(10.3f, 0.6f)};
    for (SwTlas* accel : accels_) {
        const auto is_hit = [&] {
            const std::vector<Hit> hits = accel->closest_hits(rays, {.level = GetParam()});
            return std::pair{hits[0].hit, hits[1].hit};
        };
        EXPECT_EQ(is_hit(), std::pair(0u, 0u));
        const AccelHandle first = accel->push(test::square(0));
        EXPECT_EQ(is_hit(), std::pair(1u, 0u));
        const AccelView one = accel->view();
        EXPECT_EQ(one.features & FEATURE_INSTANCES, 0u);
        const auto for_one = accel->make_program(test_program, one.features);
        const AccelHandle second = accel->push(test::square(0), Transform::translation({10, 0, 0}), {.mask = 2});
        EXPECT_EQ(is_hit(), std::pair(1u, 1u));
        test::expect_error("several instances",
                           [&] { accel->closest_hits(rays, {.level = GetParam(), .program = for_one.get()}); });
        accel->erase(first);
        EXPECT_EQ(is_hit(), std::pair(0u, 1u));
        EXPECT_EQ(accel->closest_hits(rays, {.mask = 1, .level = GetParam()})[1].hit, 0u) << "of another mask";
        accel->erase(second);
        EXPECT_EQ(is_hit(), std::pair(0u, 0u));
    }
}

TEST_P(Layouts, AgreeAfterRefits) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(-1, 1);
    Mesh soup = make_soup(700, 3, 0.2f);
    std::vector<AccelHandle> handles;
    for (SwTlas* accel : accels_) {
        handles.push_back(accel->push(soup, std::vector<Transform>(20)));
        accel->sync();
    }
    for (int step = 0; step < 3; ++step) {
        for (vec3& position : soup.positions) position += 0.3f * vec3(unit(random), unit(random), unit(random));
        std::vector<Transform> transforms;
        for (int i = 0; i < 20; ++i)
            transforms.push_back(Transform::translation(2.0f * vec3(unit(random), unit(random), unit(random))));
        for (std::size_t a = 0; a < accels_.size(); ++a) {
            accels_[a]->update_vertices(handles[a], soup.positions);
            accels_[a]->update_transforms(handles[a], transforms);
            accels_[a]->sync();
        }
        expect_equal(random_rays({vec3(-3), vec3(3)}, 10'000, static_cast<std::uint64_t>(step)));
    }
}

class Tunings : public ::testing::TestWithParam<test::LayoutAndLevel> {
  protected:
    void SetUp() override {
        const std::unique_ptr<Context> context = test::make_context();
        if (!context) return;
        if (!test::has_level(*context, level()))
            TWINRAY_LACKS("float64", context->properties().name + " has no float64");
    }
    // Returns hits of the closest and any query, and all hits, of all the scenes, as bytes in turn.
    std::vector<std::vector<std::byte>> trace_all(TuningRow row) {
        const std::unique_ptr<Context> context = test::make_context({.tuning = row});
        if (!context) return {};
        EXPECT_EQ(context->state().tuning().row, row);
        std::vector<std::vector<std::byte>> found;
        trace_scenes(*context, found);
        for (const std::string& message : context->validation_messages()) ADD_FAILURE() << message;
        return found;
    }

  private:
    static Level level() { return std::get<Level>(GetParam()); }
    void trace_scenes(Context& context, std::vector<std::vector<std::byte>>& found) {
        const AccelOptions options{std::max(level(), Level::watertight), std::get<Layout>(GetParam())};
        for (const auto& push : scenes()) {
            SwTlas accel(context, options);
            push(accel);
            // Makes more rays than a group's, so that invocations have runs where they may.
            const std::vector<Ray> rays = random_rays({vec3(-3), vec3(3)}, 40'000, 4);
            const TraceDesc desc{.level = level()};
            const std::vector<Hit> closest = accel.closest_hits(rays, desc), any = accel.any_hits(rays, desc);
            EXPECT_GT(std::ranges::count(closest, 1u, &Hit::hit), 400);
            found.push_back(bytes_of(closest));
            found.push_back(bytes_of(any));
            found.push_back(bytes_of(AllHits(accel)(std::span(rays).first(4000), desc).hits));
            // A kernel with every feature takes one instance for a scene of many.
            const std::unique_ptr<TraceProgram> program = accel.make_program(test_program);
            found.push_back(bytes_of(accel.closest_hits(rays, {.level = desc.level, .program = program.get()})));
        }
    }

    static std::vector<std::byte> bytes_of(const std::vector<Hit>& hits) {
        const std::span<const std::byte> bytes = std::as_bytes(std::span(hits));
        return {bytes.begin(), bytes.end()};
    }

    // Returns scenes of one mesh with shared edges, of overlapping boxes, for which the stack loses entries, and of
    // instances of every kind.
    static std::vector<std::function<void(SwTlas&)>> scenes() {
        return {[](SwTlas& accel) { accel.push(make_icosphere(4)); },
                [](SwTlas& accel) { accel.push(make_soup(3000, 7, 0.8f)); },
                [](SwTlas& accel) {
                    push_sixty(accel, 2, false,
                               [](uint i) { return i % 2 ? make_icosphere(2) : make_soup(400, i % 4, 0.3f); });
                }};
    }
};

INSTANTIATE_TEST_SUITE_P(Every, Tunings, ::testing::Combine(::testing::Values(Layout::compressed4), test::every_level),
                         test::name_of_layout_and_level);
INSTANTIATE_TEST_SUITE_P(Full, Tunings,
                         ::testing::Combine(::testing::Values(Layout::bvh2, Layout::compressed8), test::every_level),
                         test::name_of_layout_and_level);

TEST_P(Tunings, GiveTheSameHitsToTheLastBit) {
    const auto gpu = trace_all(TuningRow::gpu), cpu = trace_all(TuningRow::cpu_driver);
    if (HasFailure() || IsSkipped()) return;
    ASSERT_EQ(gpu.size(), cpu.size());
    for (std::size_t i = 0; i < gpu.size(); ++i) EXPECT_EQ(gpu[i], cpu[i]) << "result " << i;
}

}  // namespace
}  // namespace twinray
