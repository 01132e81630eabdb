// SPDX-License-Identifier: MIT
#include "validation/reference/float_probe.h"

#include "tests/support/device.h"

namespace twinray {
namespace {

using FloatProbe = test::VulkanTest;

TEST_F(FloatProbe, FindsArithmeticThatTheRobustLevelsCanRestOn) {
    const FloatFacts& properties = probe_floats(context());
    EXPECT_TRUE(robust_faults(properties).empty());
    EXPECT_GT(properties.product_ulp, 0.49) << "some product is rounded at all";
    EXPECT_LE(properties.product_ulp, 0.5);
    EXPECT_LE(properties.sum_ulp, 0.5);
    EXPECT_EQ(properties.has_float64, context().properties().shader_float64);
    EXPECT_TRUE(properties.fuses_fma || !context().state().tuning().has_fused_fma);
    EXPECT_EQ(&probe_floats(context()), &properties) << "once for each driver";
    RecordProperty("quotient_ulp", std::to_string(properties.quotient_ulp));
}

FloatFacts good() {
    FloatFacts properties;
    properties.product_ulp = properties.sum_ulp = properties.quotient_ulp = 0.5;
    properties.error_free_products = properties.compares_nan = true;
    return properties;
}

TEST(RobustFaults, NamesEachThingThatBreaksTheClaim) {
    EXPECT_TRUE(robust_faults(good()).empty());
    FloatFacts properties = good();
    properties.contracts_precise = true;
    properties.product_ulp = 1.5;
    EXPECT_EQ(robust_faults(properties),
              (std::vector<std::string>{"products are wrong by up to 1.5 ulp", "precise products are contracted"}));
    properties = good();
    properties.quotient_ulp = 3;
    properties.sum_ulp = 0.75;
    properties.compares_nan = properties.error_free_products = false;
    EXPECT_EQ(robust_faults(properties).size(), 4u);
}

}  // namespace
}  // namespace twinray
