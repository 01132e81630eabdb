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

}  // namespace
}  // namespace twinray
