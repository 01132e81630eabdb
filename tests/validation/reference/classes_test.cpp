// SPDX-License-Identifier: MIT
#include <twinray/validation.h>

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace twinray {
namespace {

TEST(HitClassCounts, NamesAreThoseOfTheReports) {
    EXPECT_EQ(name_of(HitClass::agree), "AGREE");
    EXPECT_EQ(name_of(HitClass::tie), "TIE");
    EXPECT_EQ(name_of(HitClass::boundary), "BOUNDARY");
    EXPECT_EQ(name_of(HitClass::boundary_hw_miss), "BOUNDARY_HW_MISS");
    EXPECT_EQ(name_of(HitClass::unspecified), "UNSPECIFIED");
    EXPECT_EQ(name_of(HitClass::invalid_input), "INVALID_INPUT");
    EXPECT_EQ(name_of(HitClass::sw_leak), "SW_LEAK");
    EXPECT_EQ(name_of(HitClass::sw_false), "SW_FALSE");
    EXPECT_EQ(name_of(HitClass::t_err), "T_ERR");
    EXPECT_EQ(name_of(HitClass::hw_leak), "HW_LEAK");
    EXPECT_EQ(name_of(HitClass::hw_false), "HW_FALSE");
    EXPECT_EQ(name_of(HitClass::hw_t_err), "HW_T_ERR");
    EXPECT_EQ(name_of(HitClass::hw_range), "HW_RANGE");
}

TEST(HitClassCounts, OnlySoftwareLeaksFalseHitsAndTErrorsAreFaultsOfOurs) {
    std::set<std::string> faults;
    for (std::size_t i = 0; i < hit_class_count; ++i)
        if (is_fault_of_ours(static_cast<HitClass>(i))) faults.emplace(name_of(static_cast<HitClass>(i)));
    EXPECT_EQ(faults, (std::set<std::string>{"SW_LEAK", "SW_FALSE", "T_ERR"}));
}

TEST(HitClassCounts, CountsAddUp) {
    HitClassCounts a, b;
    a.add(HitClass::agree);
    a.add(HitClass::sw_leak);
    b.add(HitClass::sw_leak);
    b.add(HitClass::t_err);
    b.add(HitClass::hw_leak);
    a += b;
    EXPECT_EQ(a[HitClass::sw_leak], 2u);
    EXPECT_EQ(a[HitClass::agree], 1u);
    EXPECT_EQ(a.total(), 5u);
    EXPECT_EQ(a.faults_of_ours(), 3u);
}

}  // namespace
}  // namespace twinray
