// SPDX-License-Identifier: MIT
#include "report/page/compare.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/core/error.h"

namespace twinray::report {
namespace {

Record measured(const std::string& id, double ns, std::uint64_t leaks = 0, std::uint64_t n = 4096,
                const char* backend = "hw") {
    Record record;
    record.case_id = id;
    record.params = {{"aim", "vertex"}};
    record.backend = backend;
    record.level = "watertight";
    record.n = n;
    record.seed = 1;
    record.counts = {{"AGREE", n - leaks}, {"HW_LEAK", leaks}};
    record.faults = leaks;
    record.pass = leaks == 0;
    record.fault_of = leaks ? "driver" : "";
    record.time = TimeFigures{"ns_per_ray", ns, {ns, ns}, 0, ns, 3};
    return record;
}

std::vector<Record> twenty(const std::function<Record(int)>& make) {
    std::vector<Record> records;
    for (int i = 0; i < 20; ++i) records.push_back(make(i));
    return records;
}
std::string id(int i) { return text("W", i); }

TEST(Fisher, IsTheTeaTastersTest) {
    EXPECT_NEAR(fisher_exact(3, 4, 1, 4), 0.48571428571428565, 1e-12);
    EXPECT_NEAR(fisher_exact(4, 4, 0, 4), 2.0 / 70, 1e-12);
    EXPECT_EQ(fisher_exact(5, 100, 5, 100), 1);
    EXPECT_LT(fisher_exact(0, 4096, 46, 4096), 1e-12);
}

TEST(Holm, IsStepwise) {
    EXPECT_EQ(holm(std::vector{0.01, 0.04, 0.03, 0.005}, 0.05), (std::vector{true, false, false, true}));
    EXPECT_EQ(holm(std::vector{0.02, 0.9}, 0.05), (std::vector{true, false}));
    EXPECT_EQ(holm(std::vector{0.03, 0.9}, 0.05), (std::vector{false, false}));
    EXPECT_TRUE(holm({}, 0.05).empty());
}

TEST(SignTest, IsTheBinomial) {
    EXPECT_NEAR(sign_test(10, 0), 2.0 / 1024, 1e-12);
    EXPECT_NEAR(sign_test(1, 9), 2 * 11.0 / 1024, 1e-12);
    EXPECT_EQ(sign_test(5, 5), 1);
    EXPECT_EQ(sign_test(0, 0), 1);
}

TEST(Compare, NothingChangedIsNoChange) {
    const std::vector<Record> records = twenty([](int i) { return measured(id(i), 100, 3); });
    const Comparison comparison = compare(records, records);
    EXPECT_TRUE(comparison.changes.empty());
    EXPECT_EQ(comparison.compared, 20u);
    EXPECT_FALSE(comparison.is_worse());
}

TEST(Compare, ADriverThatLosesRaysIsFound) {
    std::vector<Record> now = twenty([](int i) { return measured(id(i), 100); });
    const std::vector<Record> before = now;
    now[7] = measured(id(7), 100, 46);
    const Comparison comparison = compare(before, now);
    ASSERT_FALSE(comparison.changes.empty());
    EXPECT_EQ(comparison.changes[0].what, "W7 hw watertight {aim vertex}");
    EXPECT_EQ(comparison.changes[0].how, "HW_LEAK 0 of 4,096 (below 731 per million) -> 1.1 % (0.82 to 1.5)");
    EXPECT_TRUE(comparison.is_worse());
    const Comparison mended = compare(now, before);
    EXPECT_EQ(mended.changes[0].kind, Change::Kind::better);
    EXPECT_FALSE(mended.is_worse());
}

TEST(Compare, ChanceIsNoChange) {
    std::mt19937 random(5);
    std::binomial_distribution<std::uint64_t> leaks(4096, 0.01);
    std::normal_distribution<double> noise(0, 0.3);
    int alarms = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const auto make = [&](int i) { return measured(id(i), 100 * std::exp(noise(random)), leaks(random)); };
        alarms += !compare(twenty(make), twenty(make)).changes.empty();
    }
    EXPECT_LE(alarms, 17) << "of 200, at a stated rate of 5 %";
}

// The rays of a case share its scene, so another seed gives another rate.
TEST(Compare, ScenesOfOtherSeedsAreNoChange) {
    std::mt19937 random(5);
    std::uniform_int_distribution<std::uint64_t> leaks(0, 2000);
    int alarms = 0, of_one_seed = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const auto make = [&](int i) { return measured(id(i), 100, leaks(random)); };
        const std::vector<Record> before = twenty(make);
        std::vector<Record> now = twenty(make);
        of_one_seed += !compare(before, now).changes.empty();
        for (Record& record : now) record.seed = 2;
        alarms += !compare(before, now).changes.empty();
    }
    EXPECT_LE(alarms, 17) << "of 200, at a stated rate of 5 %";
    EXPECT_GT(of_one_seed, 100) << "where the rays are the same, such a difference is one";
}

// A case that had more time asks more rays, and as many of them are lost.
TEST(Compare, OtherAmountsAreNoChange) {
    std::vector<Record> now = twenty([](int i) { return measured(id(i), 100); });
    now[3] = measured(id(3), 100, 410, 4096);
    const std::vector<Record> before = now;
    now[3] = measured(id(3), 100, 4100, 40960);
    EXPECT_TRUE(compare(before, now).changes.empty()) << compare(before, now).changes[0].how;
    now[3] = measured(id(3), 100, 5100, 40960);
    const Comparison comparison = compare(before, now);
    ASSERT_EQ(comparison.changes.size(), 1u);
    EXPECT_EQ(comparison.changes[0].what, "W3 hw watertight {aim vertex}");
}

TEST(Compare, ADriverThatLosesRaysInAllCasesIsFoundByAnotherSeed) {
    std::mt19937 random(5);
    std::uniform_int_distribution<std::uint64_t> leaks(0, 100);
    const std::vector<Record> before = twenty([&](int i) { return measured(id(i), 100, leaks(random)); });
    std::vector<Record> now = twenty([&](int i) { return measured(id(i), 100, 200 + leaks(random)); });
    for (Record& record : now) record.seed = 2;
    const Comparison comparison = compare(before, now);
    EXPECT_FALSE(comparison.has_one_seed);
    ASSERT_EQ(comparison.changes.size(), 1u);
    EXPECT_EQ(comparison.changes[0].what, "hw watertight over all cases");
    EXPECT_TRUE(comparison.changes[0].how.ends_with(", more in 20 cases of 20")) << comparison.changes[0].how;
    EXPECT_TRUE(comparison.is_worse());
}

TEST(Compare, SlowerIsFoundBesideABusyMachine) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 0.1);
    std::vector<Record> before, now;
    for (int i = 0; i < 20; ++i)
        for (const char* backend : {"sw", "hw", "hw-pipeline"}) {
            before.push_back(measured(id(i), 100 * std::exp(noise(random)), 0, 4096, backend));
            const double slower = backend == std::string("hw") ? 1.5 : 1;
            now.push_back(measured(id(i), 200 * slower * std::exp(noise(random)), 0, 4096, backend));
        }
    const Comparison comparison = compare(before, now);
    EXPECT_NEAR(comparison.drift, 2, 0.2);
    ASSERT_EQ(comparison.changes.size(), 1u);
    EXPECT_EQ(comparison.changes[0].kind, Change::Kind::slower);
    EXPECT_EQ(comparison.changes[0].what, "times of hw watertight");
    EXPECT_EQ(comparison.times.size(), 3u);
}

TEST(Compare, AFaultOfOursAndAFlipAreCertain) {
    const std::vector<Record> before = {measured("W1", 100, 0, 8192, "sw"), measured("N1", 100, 0, 1)};
    std::vector<Record> now = before;
    now[0].fault_of = "twinray", now[0].pass = false, now[0].example = "SW_LEAK 0x1p+0";
    now[1].pass = false, now[1].fault_of = "driver", now[1].reason = "was not refused";
    const Comparison comparison = compare(before, now);
    ASSERT_EQ(comparison.changes.size(), 2u);
    EXPECT_EQ(comparison.changes[0].how, "a fault of twinray: SW_LEAK 0x1p+0");
    EXPECT_EQ(comparison.changes[1].how, "passed before, and no longer passes: was not refused");
}

TEST(Compare, WhatRanAndDoesNotIsWorse) {
    const std::vector<Record> before = {measured("W1", 100)};
    std::vector<Record> now = before;
    now[0].was_run = false, now[0].reason = "needs VK_KHR_ray_query";
    EXPECT_TRUE(compare(before, now).is_worse());
}

// A record that was not run has no settings: one stands for all of its case, accelerator and level.
TEST(Compare, ACaseThatTheDriverCannotRunAnyMoreIsWorseWhateverItsSettings) {
    std::vector<Record> before = {measured("W1", 100), measured("W1", 100), measured("W1", 100, 0, 4096, "sw")};
    before[1].params = {{"aim", "edge"}};
    std::vector<Record> now = {measured("W1", 100), before[2]};
    now[0].params.clear();
    now[0].was_run = false, now[0].reason = "the device has no ray queries";
    const Comparison comparison = compare(before, now);
    ASSERT_EQ(comparison.changes.size(), 1u);
    EXPECT_EQ(comparison.changes[0].what, "W1 hw watertight");
    EXPECT_EQ(comparison.changes[0].how, "ran before, and no longer runs: the device has no ray queries");
    EXPECT_TRUE(comparison.is_worse());
    now[0].reason = "level certified is unsupported", now[0].level = "certified";  // neither before
    EXPECT_FALSE(compare(before, now).is_worse());
}

TEST(Compare, RecordsWithoutACounterpartAreCounted) {
    const std::vector<Record> before = {measured("W1", 100), measured("W2", 100)},
                              now = {measured("W2", 100), measured("W3", 100)};
    const Comparison comparison = compare(before, now);
    EXPECT_EQ(comparison.compared, 1u);
    EXPECT_EQ(comparison.only_before, 1u);
    EXPECT_EQ(comparison.only_now, 1u);
}

}  // namespace
}  // namespace twinray::report
