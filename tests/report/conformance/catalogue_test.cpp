// SPDX-License-Identifier: MIT
#include "report/conformance/suite.h"

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
        EXPECT_FALSE(row.title.empty() || row.measures.empty() || row.criterion.empty()) << row.id;
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

// A process that the driver ended leaves the first records of a case, in this order.
TEST(ConformanceEnded, CasesAreAFaultOfTheDriverWhereTheyWereBegun) {
    const Case row = catalogue()[3];
    std::vector<Record> all;
    for (const char* backend : {"hw", "hw-pipeline"})
        for (const char* variant : {"", "control: a driver that errs"}) {
            Record record;
            record.case_id = row.id;
            record.backend = backend;
            record.variant = variant;
            all.push_back(record);
        }
    const auto missing = [&](std::size_t finished) {
        return records_of_ended(row, std::span(all).first(finished), {}, "the driver ended the process");
    };
    const std::vector<Record> none = missing(0);
    ASSERT_EQ(none.size(), 2u);
    EXPECT_EQ(none[0].backend, "hw");
    EXPECT_EQ(none[0].variant, "");
    EXPECT_EQ(none[0].pass, false);
    EXPECT_EQ(none[0].fault_of, "driver");
    EXPECT_EQ(none[0].reason, "the driver ended the process");
    EXPECT_FALSE(none[1].was_run);
    ASSERT_EQ(missing(1).size(), 2u) << "it died in the control";
    EXPECT_TRUE(missing(1)[0].variant.starts_with("control"));
    ASSERT_EQ(missing(2).size(), 1u);
    EXPECT_EQ(missing(2)[0].backend, "hw-pipeline");
    EXPECT_EQ(missing(2)[0].pass, false);
    ASSERT_EQ(missing(3).size(), 1u);
    EXPECT_TRUE(missing(3)[0].variant.starts_with("control"));
    EXPECT_TRUE(missing(4).empty());
    all[0].was_run = all[2].was_run = false;
    EXPECT_TRUE(records_of_ended(row, std::vector{all[0], all[2]}, {}, "").empty())
        << "what is left out has no control";
}

}  // namespace
}  // namespace twinray::conformance
