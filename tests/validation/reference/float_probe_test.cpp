// SPDX-License-Identifier: MIT
#include "validation/reference/float_probe.h"

#include "tests/support/device.h"

namespace twinray {
namespace {

using FloatProbe = test::VulkanTest;

TEST_F(FloatProbe, FindsArithmeticThatTheRobustLevelsCanRestOn) {
    const FloatFacts& facts = probe_floats(context());
    EXPECT_TRUE(robust_faults(facts).empty());
    EXPECT_GT(facts.product_ulp, 0.49) << "some product is rounded at all";
    EXPECT_LE(facts.product_ulp, 0.5);
    EXPECT_LE(facts.sum_ulp, 0.5);
    EXPECT_EQ(facts.has_float64, context().facts().shader_float64);
    EXPECT_TRUE(facts.fuses_fma || !context().state().tuning().has_fused_fma);
    EXPECT_EQ(&probe_floats(context()), &facts) << "once for each driver";
    RecordProperty("quotient_ulp", std::to_string(facts.quotient_ulp));
}

FloatFacts good() {
    FloatFacts facts;
    facts.product_ulp = facts.sum_ulp = facts.quotient_ulp = 0.5;
    facts.error_free_products = facts.compares_nan = true;
    return facts;
}

TEST(RobustFaults, NamesEachThingThatBreaksTheClaim) {
    EXPECT_TRUE(robust_faults(good()).empty());
    FloatFacts facts = good();
    facts.contracts_precise = true;
    facts.product_ulp = 1.5;
    EXPECT_EQ(robust_faults(facts),
              (std::vector<std::string>{"products are wrong by up to 1.5 ulp", "precise products are contracted"}));
    facts = good();
    facts.quotient_ulp = 3;
    facts.sum_ulp = 0.75;
    facts.compares_nan = facts.error_free_products = false;
    EXPECT_EQ(robust_faults(facts).size(), 4u);
}

}  // namespace
}  // namespace twinray
