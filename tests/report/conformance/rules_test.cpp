// SPDX-License-Identifier: MIT
#include "report/conformance/rules.h"

#include <gtest/gtest.h>

namespace twinray::conformance {
namespace {

constexpr VkGeometryFlagsKHR opaque = VK_GEOMETRY_OPAQUE_BIT_KHR;
constexpr VkGeometryInstanceFlagsKHR force_opaque = VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR,
                                     force_no_opaque = VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR,
                                     no_culling = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR,
                                     flipped = VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR;

TEST(ConformanceRules, TheRaySaysLastWhatIsOpaque) {
    EXPECT_TRUE(is_opaque({opaque, 0, 0}));
    EXPECT_FALSE(is_opaque({0, 0, 0}));
    EXPECT_FALSE(is_opaque({opaque, force_no_opaque, 0}));
    EXPECT_TRUE(is_opaque({0, force_opaque, 0}));
    EXPECT_TRUE(is_opaque({opaque, force_no_opaque, ray_opaque}));
    EXPECT_FALSE(is_opaque({0, force_opaque, ray_no_opaque}));
}

TEST(ConformanceRules, OpacityIsCulledAsItCameOut) {
    EXPECT_TRUE(is_culled_triangle({opaque, 0, ray_culls_opaque}, true));
    EXPECT_FALSE(is_culled_triangle({opaque, force_no_opaque, ray_culls_opaque}, true));
    EXPECT_TRUE(is_culled_box({opaque, force_no_opaque, ray_culls_no_opaque}));
    EXPECT_FALSE(is_culled_box({opaque, 0, ray_culls_no_opaque}));
}

TEST(ConformanceRules, FacesAreCulledUnlessTheInstanceForbids) {
    EXPECT_TRUE(is_culled_triangle({opaque, 0, ray_culls_back}, false));
    EXPECT_FALSE(is_culled_triangle({opaque, 0, ray_culls_back}, true));
    EXPECT_TRUE(is_culled_triangle({opaque, 0, ray_culls_front}, true));
    EXPECT_TRUE(is_culled_triangle({opaque, flipped, ray_culls_back}, true));
    EXPECT_FALSE(is_culled_triangle({opaque, flipped, ray_culls_back}, false));
    EXPECT_FALSE(is_culled_triangle({opaque, no_culling, ray_culls_back}, false));
    EXPECT_FALSE(is_culled_box({opaque, 0, ray_culls_back | ray_culls_front}));
}

TEST(ConformanceRules, KindsAreSkippedWhateverTheInstanceSays) {
    EXPECT_TRUE(is_culled_triangle({opaque, no_culling, ray_skips_triangles}, true));
    EXPECT_FALSE(is_culled_box({opaque, 0, ray_skips_triangles}));
    EXPECT_TRUE(is_culled_box({opaque, 0, ray_skips_boxes}));
    EXPECT_FALSE(is_culled_triangle({opaque, 0, ray_skips_boxes}, true));
}

}  // namespace
}  // namespace twinray::conformance
