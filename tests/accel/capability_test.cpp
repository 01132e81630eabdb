// SPDX-License-Identifier: MIT
#include <twinray/trace.h>

#include <set>

#include <gtest/gtest.h>

#include <twinray/tlas.h>

namespace twinray {
namespace {

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

}  // namespace
}  // namespace twinray
