// SPDX-License-Identifier: MIT
#include "validation/report/baseline.h"

#include <gtest/gtest.h>

namespace twinray::report {
namespace {

Record measured(double ns, Interval spread) {
    Record record;
    record.device = {"device", "driver", "1.3"};
    record.case_id = "W04";
    record.params = {{"aim", "vertex"}};
    record.backend = "sw";
    record.level = "watertight";
    record.n = 1000;
    record.counts = {{"AGREE", 1000}};
    record.pass = true;
    record.time = TimeFigures{"ns_per_ray", ns, spread, 1, ns, 15};
    return record;
}

std::vector<Change> changes(const Record& before, const Record& now) {
    return worse_than(std::span(&before, 1), std::span(&now, 1));
}

TEST(Baseline, NothingChangedIsNothingWorse) {
    EXPECT_TRUE(changes(measured(100, {98, 102}), measured(100, {98, 102})).empty());
    EXPECT_TRUE(changes(measured(100, {98, 102}), measured(50, {49, 51})).empty());
}

TEST(Baseline, SlowerByMoreThan5PercentAndOutsideTheSpread) {
    const Record before = measured(100, {98, 102});
    const std::vector<Change> slower = changes(before, measured(120, {118, 122}));
    ASSERT_EQ(slower.size(), 1u);
    EXPECT_TRUE(slower[0].is_slower);
    EXPECT_EQ(slower[0].what, "W04 sw watertight {aim vertex}");
    EXPECT_EQ(slower[0].how, "ns_per_ray 100 -> 120 (+20 %), outside the spread");
    EXPECT_TRUE(changes(before, measured(104, {103, 105})).empty()) << "less than 5 %";
    EXPECT_TRUE(changes(before, measured(120, {101, 140})).empty()) << "within the spread";
    Record elsewhere = measured(120, {118, 122});
    elsewhere.device.driver = "another";
    EXPECT_TRUE(changes(before, elsewhere).empty()) << "another driver";
}

TEST(Baseline, WhatAllTimesHaveInCommonIsOneChange) {
    std::vector<Record> before, now;
    for (int i = 0; i < 9; ++i) {
        before.push_back(measured(100, {98, 102}));
        now.push_back(measured(120, {118, 122}));
        for (Record* record : {&before.back(), &now.back()}) record->params = {{"setting", i}};
    }
    now[4].time = TimeFigures{"ns_per_ray", 150, {148, 152}, 1, 147, 15};
    const std::vector<Change> changes = worse_than(before, now);
    ASSERT_EQ(changes.size(), 2u);
    EXPECT_EQ(changes[0].what, "all times together");
    EXPECT_NE(changes[0].how.find("ratios is 1.2:"), std::string::npos) << changes[0].how;
    EXPECT_EQ(changes[1].what, "W04 sw watertight {setting 4}");
}

TEST(Baseline, MoreOfAnyClassButAgreeAndTie) {
    const Record before = measured(100, {98, 102});
    Record now = before;
    now.counts = {{"AGREE", 996}, {"TIE", 1}, {"BOUNDARY", 3}};
    ASSERT_EQ(changes(before, now).size(), 1u);
    EXPECT_EQ(changes(before, now)[0].how, "BOUNDARY 0 of 1000 -> 3 of 1000");
    now.n = 4000;
    Record more = before;
    more.counts["BOUNDARY"] = 1;
    EXPECT_TRUE(changes(more, now).empty()) << "the rate is smaller";
}

TEST(Baseline, ResultsAndCasesThatRanNoLonger) {
    const Record before = measured(100, {98, 102});
    Record failed = before;
    failed.pass = false;
    failed.faults = 2;
    failed.counts["SW_LEAK"] = 2;
    EXPECT_EQ(changes(before, failed).size(), 2u);
    EXPECT_TRUE(changes(failed, before).empty());
    Record skipped = before;
    skipped.was_run = false;
    skipped.reason = "why";
    ASSERT_EQ(changes(before, skipped).size(), 1u);
    EXPECT_EQ(changes(before, skipped)[0].how, "was run, and is not: why");
}

TEST(Baseline, FaultsOfAControlAreWanted) {
    Record before = measured(100, {98, 102});
    before.variant = "control: fast";
    Record now = before;
    now.counts["SW_LEAK"] = 5;
    EXPECT_TRUE(changes(before, now).empty());
    now.pass = false;
    EXPECT_EQ(changes(before, now).size(), 1u);
}

TEST(Baseline, OtherSettingsAreOtherMeasurements) {
    Record other = measured(900, {898, 902});
    other.params = {{"aim", "edge"}};
    EXPECT_TRUE(changes(measured(100, {98, 102}), other).empty());
}

TEST(Baseline, CountsWhatHasACounterpart) {
    const Record known = measured(100, {98, 102});
    Record other = known;
    other.level = "refined";
    EXPECT_EQ(count_comparable(std::vector{known}, std::vector{known, other}), 1u);
    EXPECT_EQ(count_comparable({}, std::vector{known, other}), 0u);
}

}  // namespace
}  // namespace twinray::report
