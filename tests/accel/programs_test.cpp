// Features that accelerators have on a device and that traces need, which program serves while others are compiled, and
// which accelerator is chosen.
#include "engine/accel/trace_desc.h"

#include <atomic>
#include <semaphore>
#include <set>

#include <twinray/tlas.h>
#include <twinray/trace.h>
#include "engine/accel/pipeline_variants.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

constexpr AccelTraits software{}, bvh2{.layout = Layout::bvh2}, hardware{.is_software = false};

TEST(FeaturesOf, TheSimplestTraceNeedsItsLayoutAndItsHits) {
    EXPECT_EQ(features_of(software, {}, {}), FEATURE_COMPRESSED | FEATURE_HITS);
    EXPECT_EQ(features_of(bvh2, {}, {}), FEATURE_BVH2 | FEATURE_HITS);
    EXPECT_EQ(features_of(hardware, {}, {}), FEATURE_HITS);
    EXPECT_EQ(features_of({.is_software = false, .reorders = true}, {}, {}), FEATURE_REMAP | FEATURE_HITS);
}

TEST(FeaturesOf, EachFactOfTheSceneAddsItsFeature) {
    const auto added = [](const SceneTraits& scene) {
        return features_of(software, scene, {}) & ~features_of(software, {}, {});
    };
    EXPECT_EQ(added({.has_boxes = true}), FEATURE_BOXES);
    EXPECT_EQ(added({.has_filters = true}), FEATURE_FILTERS);
    EXPECT_EQ(added({.instances = 0}), FEATURE_INSTANCES) << "nothing to enter";
    EXPECT_EQ(added({.instances = 2}), FEATURE_INSTANCES);
    EXPECT_EQ(added({.has_transforms = true}), FEATURE_TRANSFORMS);
}

TEST(FeaturesOf, MasksCountWhereOneInstanceMayBeHidden) {
    const auto has_masks = [](uint common_mask, uint mask) {
        return (features_of(software, {.common_mask = common_mask}, {.mask = mask}) & FEATURE_MASKS) != 0;
    };
    EXPECT_FALSE(has_masks(0xff, 0xff));
    EXPECT_FALSE(has_masks(0xff, 4)) << "all are seen";
    EXPECT_FALSE(has_masks(6, 4));
    EXPECT_TRUE(has_masks(6, 1));
    EXPECT_TRUE(has_masks(0, 0xff));
    EXPECT_TRUE(has_masks(0xff, 0)) << "none is seen";
}

TEST(FeaturesOf, TheTraceSaysWhetherItCullsAndWhatItWants) {
    const auto of = [](const TraceDesc& desc) { return features_of(software, {}, TraceTraits::of(desc)); };
    const uint least = FEATURE_COMPRESSED | FEATURE_HITS;
    EXPECT_EQ(of({.cull = Cull::front}), least | FEATURE_CULLING);
    EXPECT_EQ(of({.query = Query::any}), least);
    EXPECT_EQ(of({.query = Query::any, .occlusion_only = true}), FEATURE_COMPRESSED);
    EXPECT_EQ(of({.query = Query::closest, .occlusion_only = true}), least) << "of any hits alone";
    EXPECT_EQ(of({.mask = 0}), least | FEATURE_MASKS);
}

TEST(FeaturesOf, HardwareLeavesTheRestToTheDriver) {
    EXPECT_EQ(features_of(hardware, SceneTraits::of_every_kind(), TraceTraits::of_every_kind()), FEATURE_HITS);
}

// So an accelerator keeps at most that many programs.
TEST(FeaturesOf, AnAcceleratorHas32SetsAtMostAndOneHoldsThemAll) {
    const uint all = features_of(software, SceneTraits::of_every_kind(), TraceTraits::of_every_kind());
    std::set<uint> sets;
    for (const std::size_t instances : {0, 1, 2})
        for (const uint common_mask : {0u, 1u, 0xffu})
            for (const bool has_transforms : {false, true})
                for (const uint mask : {0u, 2u, 0xffu})
                    for (const bool culls : {false, true})
                        for (const bool wants_hits : {false, true})
                            sets.insert(features_of(
                                software,
                                {.instances = instances, .common_mask = common_mask, .has_transforms = has_transforms},
                                {.mask = mask, .culls = culls, .wants_hits = wants_hits}));
    EXPECT_EQ(sets.size(), 32u);
    for (const uint features : sets) EXPECT_EQ(features & ~all, 0u);
}

constexpr uint all_programs = 7;

class PipelineVariantsTest : public ::testing::Test {
  protected:
    // Compiles while it holds `gate`; features 4 cannot be compiled.
    class Program : public TraceProgram {
      public:
        Program(PipelineVariantsTest& test, uint features) : TraceProgram(1, features, "test"), test_(test) {}
        void prepare(Query, Level) const override {
            test_.gate.acquire();
            test_.gate.release();
            if (features() == 4) fail("cannot be compiled");
            ++test_.compiled;
        }
        void record(Commands&, const TraceArgs&, Query, Level) const override {}

      private:
        PipelineVariantsTest& test_;
    };

    std::unique_ptr<PipelineVariants> make(bool in_background) {
        return std::make_unique<PipelineVariants>(
            [this](uint features) { return std::make_unique<Program>(*this, features); }, all_programs, in_background);
    }
    // Makes variants with the program for features 1 and the general one.
    std::unique_ptr<PipelineVariants> make_with_both() {
        std::unique_ptr<PipelineVariants> programs = make(true);
        for (int i = 0; i < 2; ++i) serving(*programs, 1);
        programs->wait();
        return programs;
    }
    static uint serving(PipelineVariants& programs, uint features, Query query = Query::closest) {
        return programs.get(features, query, Level::watertight).features();
    }

    std::counting_semaphore<> gate{1};
    std::atomic<int> compiled = 0;
};

TEST_F(PipelineVariantsTest, TheFirstTraceHasTheProgramThatFitsAndTheSecondWantsTheGeneralOne) {
    const auto programs = make(true);
    EXPECT_EQ(serving(*programs, 1), 1u);
    programs->wait();
    EXPECT_EQ(compiled, 1);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(serving(*programs, 1), 1u);
    programs->wait();
    EXPECT_EQ(compiled, 2);
}

TEST_F(PipelineVariantsTest, TheGeneralOneServesUntilTheLeanOneIsThere) {
    const auto programs = make_with_both();
    gate.acquire();
    EXPECT_EQ(serving(*programs, 2), all_programs);
    EXPECT_EQ(serving(*programs, 2), all_programs);
    EXPECT_EQ(serving(*programs, 1), 1u) << "is there already";
    gate.release();
    programs->wait();
    EXPECT_EQ(serving(*programs, 2), 2u);
    EXPECT_EQ(compiled, 3);
    EXPECT_EQ(serving(*programs, 2, Query::any), 2u) << "first of its kind";
}

TEST_F(PipelineVariantsTest, WithoutABackgroundEachTraceWaits) {
    const auto programs = make(false);
    for (const uint features : {1u, 2u, all_programs}) EXPECT_EQ(serving(*programs, features), features);
    EXPECT_EQ(compiled, 3);
}

TEST_F(PipelineVariantsTest, WhatFailsInTheBackgroundIsNeverServed) {
    const auto programs = make(true);
    EXPECT_THROW(serving(*programs, 4), Error) << "no other is there";
    for (int i = 0; i < 2; ++i) serving(*programs, 1);
    programs->wait();
    EXPECT_EQ(serving(*programs, 4), all_programs);
    programs->wait();
    EXPECT_EQ(serving(*programs, 4), all_programs);
}

TEST_F(PipelineVariantsTest, TheEndWaitsForTheOneThatIsBeingCompiledAlone) {
    auto programs = make_with_both();
    gate.acquire();
    serving(*programs, 2);
    serving(*programs, 3);
    std::thread release([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        gate.release();
    });
    programs.reset();
    release.join();
    EXPECT_LE(compiled, 3);
}

TEST(Capability, EveryFeatureHasANameOfItsOwn) {
    std::set<std::string> names;
    for (std::size_t i = 0; i < feature_count; ++i) names.insert(name_of(static_cast<Feature>(i)));
    EXPECT_EQ(names.size(), feature_count);
}

TEST(Capability, LevelsHaveTheirFeatures) {
    EXPECT_EQ(feature_of(Level::fast), Feature::level_fast);
    EXPECT_EQ(feature_of(Level::certified), Feature::level_certified);
}

TEST(Capability, QueriesInKernelsNeedRayQueriesOnHardwareAlone) {
    DeviceProperties device;
    EXPECT_EQ(HwTlas::capability_on(device, Feature::kernel_queries).support, Support::unsupported);
    EXPECT_EQ(SwTlas::capability_on(device, Feature::kernel_queries).support, Support::native);
    device.ray_query = true;
    EXPECT_EQ(HwTlas::capability_on(device, Feature::kernel_queries).support, Support::native);
}

TEST(Capability, WhatIsUnsupportedSaysWhy) {
    for (std::size_t i = 0; i < feature_count; ++i)
        for (const Capability& capability :
             {HwTlas::capability_on({}, static_cast<Feature>(i)), SwTlas::capability_on({}, static_cast<Feature>(i))})
            EXPECT_TRUE(capability.support != Support::unsupported || !capability.note.empty())
                << name_of(capability.feature);
}

DeviceProperties device_of(DeviceKind kind) {
    DeviceProperties device;
    device.name = "GPU 9";
    device.kind = kind;
    device.api_version = (1u << 22) | (2u << 12);  // Vulkan 1.2
    device.has_compute_queue = device.timeline_semaphore = device.buffer_device_address = true;
    device.scalar_block_layout = device.shader_int64 = true;
    device.group_invocations = 1024;
    device.acceleration_structure = device.ray_query = device.ray_tracing_pipeline = true;
    return device;
}

std::string refusal_of(const DeviceProperties& device, const std::string& request, const AccelNeeds& needs = {}) {
    return test::error_of([&] { choose_accel(device, request, needs); });
}

TEST(AccelChoice, AutomaticIsHardwareWhereTheDeviceHasIt) {
    for (const DeviceKind kind :
         {DeviceKind::discrete, DeviceKind::integrated, DeviceKind::virtual_gpu, DeviceKind::other})
        EXPECT_EQ(choose_accel(device_of(kind), "auto"), (AccelChoice{false, "device 'GPU 9' has VK_KHR_ray_query"}));
    DeviceProperties pipelines = device_of(DeviceKind::discrete);
    pipelines.ray_query = false;
    EXPECT_EQ(choose_accel(pipelines, "auto"), (AccelChoice{false, "device 'GPU 9' has VK_KHR_ray_tracing_pipeline"}));
}

TEST(AccelChoice, AutomaticIsSoftwareOnACpu) {
    EXPECT_EQ(choose_accel(device_of(DeviceKind::cpu), "auto"),
              (AccelChoice{true, "device 'GPU 9' is a CPU, without hardware for rays"}));
    EXPECT_FALSE(choose_accel(device_of(DeviceKind::cpu), "hw").is_software) << "it works where it is asked for";
}

TEST(AccelChoice, WhatHardwareLacksIsNamed) {
    DeviceProperties none = device_of(DeviceKind::discrete);
    none.acceleration_structure = none.ray_query = none.ray_tracing_pipeline = false;
    EXPECT_EQ(choose_accel(none, "auto"),
              (AccelChoice{true,
                           "device 'GPU 9' lacks VK_KHR_acceleration_structure, VK_KHR_ray_query or "
                           "VK_KHR_ray_tracing_pipeline"}));
    EXPECT_EQ(refusal_of(none, "hw"),
              "--accel hw: device 'GPU 9' lacks VK_KHR_acceleration_structure, VK_KHR_ray_query or "
              "VK_KHR_ray_tracing_pipeline; --accel sw works there");
    EXPECT_EQ(choose_accel(none, "sw"), (AccelChoice{true, "asked for"}));
}

TEST(AccelChoice, NeedsThatHardwareDoesNotMeetChooseSoftware) {
    DeviceProperties device = device_of(DeviceKind::discrete);
    const AccelNeeds certified{.level = Level::certified}, kernels{.kernel_queries = true};
    EXPECT_FALSE(choose_accel(device, "auto", {.level = Level::refined}).is_software);
    EXPECT_FALSE(choose_accel(device, "auto", kernels).is_software);
    EXPECT_TRUE(choose_accel(device, "auto", certified).is_software);
    EXPECT_NE(refusal_of(device, "hw", certified).find("level certified is of software alone"), std::string::npos);
    device.ray_query = false;
    EXPECT_TRUE(choose_accel(device, "auto", kernels).is_software);
    EXPECT_NE(refusal_of(device, "hw", kernels).find("lacks VK_KHR_ray_query"), std::string::npos);
    EXPECT_FALSE(choose_accel(device, "hw").is_software);
}

TEST(AccelChoice, NothingElseIsTaken) {
    EXPECT_EQ(refusal_of(device_of(DeviceKind::cpu), "gpu"), "accelerator 'gpu' is not auto, sw or hw");
}

}  // namespace
}  // namespace twinray
