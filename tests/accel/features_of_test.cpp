// SPDX-License-Identifier: MIT
// Which features a trace needs.
#include "engine/accel/features_of.h"

#include <gtest/gtest.h>

#include <set>

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

// So that an accelerator keeps as many programs at most.
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

}  // namespace
}  // namespace twinray
