// SPDX-License-Identifier: MIT
#include "engine/verify/classes.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace twinray {
namespace {

TEST(Classes, NamesAreThoseOfTheReports) {
    EXPECT_EQ(name(Class::agree), "AGREE");
    EXPECT_EQ(name(Class::tie), "TIE");
    EXPECT_EQ(name(Class::boundary), "BOUNDARY");
    EXPECT_EQ(name(Class::boundary_hw_miss), "BOUNDARY_HW_MISS");
    EXPECT_EQ(name(Class::unspecified), "UNSPECIFIED");
    EXPECT_EQ(name(Class::invalid_input), "INVALID_INPUT");
    EXPECT_EQ(name(Class::sw_leak), "SW_LEAK");
    EXPECT_EQ(name(Class::sw_false), "SW_FALSE");
    EXPECT_EQ(name(Class::t_err), "T_ERR");
    EXPECT_EQ(name(Class::hw_leak), "HW_LEAK");
    EXPECT_EQ(name(Class::hw_false), "HW_FALSE");
    EXPECT_EQ(name(Class::hw_t_err), "HW_T_ERR");
    EXPECT_EQ(name(Class::hw_range), "HW_RANGE");
}

TEST(Classes, OnlySoftwareLeaksFalseHitsAndTErrorsAreFaultsOfOurs) {
    std::set<std::string> faults;
    for (std::size_t i = 0; i < class_count; ++i)
        if (is_fault_of_ours(static_cast<Class>(i))) faults.emplace(name(static_cast<Class>(i)));
    EXPECT_EQ(faults, (std::set<std::string>{"SW_LEAK", "SW_FALSE", "T_ERR"}));
}

TEST(Classes, CountsAddUp) {
    Classes a, b;
    a.add(Class::agree);
    a.add(Class::sw_leak);
    b.add(Class::sw_leak);
    b.add(Class::t_err);
    b.add(Class::hw_leak);
    a += b;
    EXPECT_EQ(a[Class::sw_leak], 2u);
    EXPECT_EQ(a[Class::agree], 1u);
    EXPECT_EQ(a.total(), 5u);
    EXPECT_EQ(a.faults_of_ours(), 3u);
}

// Reference values: bisection on the binomial tail summed term by term in Python's math module.
TEST(UpperBound95, IsClopperPearsons) {
    EXPECT_NEAR(upper_bound_95(0, 1000), 0.0029912495451, 1e-12);
    EXPECT_NEAR(upper_bound_95(1, 100), 0.0465598114535, 1e-10);
    EXPECT_NEAR(upper_bound_95(5, 100), 0.102253377643, 1e-10);
    EXPECT_NEAR(upper_bound_95(3, 1000000), 7.75363810049e-06, 1e-13);
    EXPECT_NEAR(upper_bound_95(1000, 1000000), 0.00105357487745, 1e-11);
    EXPECT_NEAR(upper_bound_95(99, 100), 0.999487198584, 1e-10);
    EXPECT_NEAR(upper_bound_95(50, 60), 0.906693067295, 1e-10);
}

TEST(UpperBound95, OfNoEventIsTheRuleOfThree) {
    for (const std::uint64_t n : {1000u, 1000000u, 1000000000u})
        EXPECT_NEAR(upper_bound_95(0, n) * static_cast<double>(n), 3, 0.01);
}

TEST(UpperBound95, IsOneWhereNothingIsKnown) {
    EXPECT_EQ(upper_bound_95(0, 0), 1);
    EXPECT_EQ(upper_bound_95(5, 5), 1);
    EXPECT_EQ(upper_bound_95(6, 5), 1);
}

TEST(UpperBound95, GrowsWithTheCount) {
    double before = 0;
    for (std::uint64_t count = 0; count < 100000; count += 997) {
        const double bound = upper_bound_95(count, 100000);
        EXPECT_GT(bound, before);
        EXPECT_GT(bound, static_cast<double>(count) / 100000);
        before = bound;
    }
}

}  // namespace
}  // namespace twinray
