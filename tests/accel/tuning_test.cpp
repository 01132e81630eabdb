// SPDX-License-Identifier: MIT
// Both rows of KernelTuning on one device: the same hits to the last bit.
#include <cstring>
#include <random>

#include <twinray/queries.h>
#include "validation/reference/aimed_rays.h"
#include "test_program.trace_program.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

struct Setting {
    Layout layout;
    Level level;
};

class Tunings : public ::testing::TestWithParam<Setting> {
  protected:
    void SetUp() override {
        const std::unique_ptr<Context> context = test::make_context();
        if (!context) return;
        if (SwTlas::capability_on(context->properties(), feature_of(GetParam().level)).support == Support::unsupported)
            TWINRAY_LACKS("float64", context->properties().name + " has no float64");
    }
    // Of all the scenes, hits of the closest and any query, and all hits, as bytes in turn.
    std::vector<std::vector<std::byte>> trace_all(TuningRow row) {
        ContextDesc desc;
        desc.tuning = row;
        const std::unique_ptr<Context> context = test::make_context(desc);
        if (!context) return {};
        EXPECT_EQ(context->state().tuning().row, row);
        std::vector<std::vector<std::byte>> found;
        trace_scenes(*context, found);
        for (const std::string& message : context->validation_messages()) ADD_FAILURE() << message;
        return found;
    }

  private:
    void trace_scenes(Context& context, std::vector<std::vector<std::byte>>& found) {
        const AccelOptions options{std::max(GetParam().level, Level::watertight), GetParam().layout};
        for (const auto& push : scenes()) {
            SwTlas accel(context, options);
            push(accel);
            // More than a group's, so that invocations have runs where they may.
            const std::vector<Ray> rays = random_rays({vec3(-3), vec3(3)}, 40'000, 4);
            const TraceDesc desc{.level = GetParam().level};
            const std::vector<Hit> closest = accel.closest_hits(rays, desc), any = accel.any_hits(rays, desc);
            EXPECT_GT(std::ranges::count(closest, 1u, &Hit::hit), 400);
            found.push_back(bytes_of(closest));
            found.push_back(bytes_of(any));
            found.push_back(bytes_of(AllHits(accel)(std::span(rays).first(4000), desc).hits));
            // A kernel of every feature takes one instance for a scene of many.
            const std::unique_ptr<TraceProgram> program = accel.make_program(test_program);
            found.push_back(bytes_of(accel.closest_hits(rays, {.level = desc.level, .program = program.get()})));
        }
    }

    static std::vector<std::byte> bytes_of(const std::vector<Hit>& hits) {
        const std::span<const std::byte> bytes = std::as_bytes(std::span(hits));
        return {bytes.begin(), bytes.end()};
    }

    // One mesh of shared edges; boxes that overlap, in which the stack loses entries; instances of every kind.
    static std::vector<std::function<void(SwTlas&)>> scenes() {
        return {[](SwTlas& accel) { accel.push(make_icosphere(4)); },
                [](SwTlas& accel) { accel.push(make_soup(3000, 7, 0.8f)); },
                [](SwTlas& accel) {
                    std::mt19937 random(3);
                    std::uniform_real_distribution<float> unit(-1, 1);
                    for (uint i = 0; i < 60; ++i) {
                        const vec3 place = 2.0f * vec3(unit(random), unit(random), unit(random));
                        const vec3 size(unit(random), 0.7f, i % 5 ? 1 : -1e-3f);
                        accel.push(i % 2 ? make_icosphere(2) : make_soup(400, i % 4, 0.3f),
                                   Transform::translation(place) * Transform::scaling(size),
                                   {.custom_index = i, .mask = static_cast<std::uint8_t>(1 + i % 3)});
                    }
                }};
    }
};

std::vector<Setting> every_level_of(const std::vector<Layout>& layouts) {
    std::vector<Setting> settings;
    for (const Layout layout : layouts)
        for (const Level level : {Level::fast, Level::watertight, Level::refined, Level::certified})
            settings.push_back({layout, level});
    return settings;
}
std::string name_of_setting(const ::testing::TestParamInfo<Setting>& info) {
    const char* levels[] = {"fast", "watertight", "refined", "certified"};
    return text(name_of(info.param.layout), '_', levels[static_cast<std::size_t>(info.param.level)]);
}
INSTANTIATE_TEST_SUITE_P(Every, Tunings, ::testing::ValuesIn(every_level_of({Layout::compressed4})), name_of_setting);
INSTANTIATE_TEST_SUITE_P(Full, Tunings, ::testing::ValuesIn(every_level_of({Layout::bvh2, Layout::compressed8})),
                         name_of_setting);

TEST_P(Tunings, GiveTheSameHitsToTheLastBit) {
    const auto gpu = trace_all(TuningRow::gpu), cpu = trace_all(TuningRow::cpu_driver);
    if (HasFailure() || IsSkipped()) return;
    ASSERT_EQ(gpu.size(), cpu.size());
    for (std::size_t i = 0; i < gpu.size(); ++i) EXPECT_EQ(gpu[i], cpu[i]) << "result " << i;
}

}  // namespace
}  // namespace twinray
