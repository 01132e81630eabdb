// SPDX-License-Identifier: MIT
#include "validation/conformance/suite.h"

#include <gtest/gtest.h>

#include <set>

#include "engine/core/error.h"

namespace twinray::conformance {
namespace {

TEST(ConformanceCatalogue, HasEveryCaseOnceInOrder) {
    const std::vector<Case> all = catalogue();
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].id, text('K', i < 9 ? "0" : "", i + 1));
    EXPECT_GT(all.size(), 90u);
}

TEST(ConformanceCatalogue, EachRowSaysWhatItIsAndHasAControl) {
    std::set<Topic> topics;
    for (const Case& row : catalogue()) {
        topics.insert(row.topic);
        EXPECT_FALSE(row.what.empty() || row.kind.empty() || row.demanded.empty()) << row.id;
        EXPECT_TRUE(row.run) << row.id;
        EXPECT_NE(row.control, Misdeed::none) << row.id;
    }
    EXPECT_EQ(topics.size(), topic_count);
}

TEST(ConformanceCatalogue, NamesTellApart) {
    std::set<std::string_view> topics, misdeeds;
    for (std::size_t i = 0; i < topic_count; ++i) topics.insert(name_of(static_cast<Topic>(i)));
    for (std::size_t i = 0; i < misdeed_count; ++i) misdeeds.insert(name_of(static_cast<Misdeed>(i)));
    EXPECT_EQ(topics.size(), topic_count);
    EXPECT_EQ(misdeeds.size(), misdeed_count);
}

Record record(bool pass, const char* fault_of, const char* demand, const char* variant = "") {
    Record record;
    record.pass = pass;
    record.fault_of = fault_of;
    record.variant = variant;
    record.results = {{"demand", demand}};
    return record;
}

TEST(ConformanceRecords, OnlyWhatVulkanDemandsFails) {
    EXPECT_TRUE(fails_demands(std::vector{record(true, "", "must"), record(false, "driver", "must")}));
    EXPECT_FALSE(fails_demands(std::vector{record(true, "", "must"), record(false, "driver", "should")}));
    EXPECT_FALSE(fails_demands(std::vector{record(false, "twinray", "must", "control: leaks")}));
    EXPECT_TRUE(has_fault_of_ours(std::vector{record(false, "twinray", "must", "control: leaks")}));
    EXPECT_FALSE(has_fault_of_ours(std::vector{record(false, "driver", "must")}));
}

}  // namespace
}  // namespace twinray::conformance
