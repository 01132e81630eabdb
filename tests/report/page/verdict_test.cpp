// The statements of a report about its records: findings, the verdict, and what has changed since an earlier run.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "engine/core/error.h"
#include "report/page/compare.h"
#include "report/page/verdict.h"
#include "report/page/wording.h"
#include "report/suite/suite.h"

namespace twinray::report {
namespace {

Record checked(const char* id, const char* backend, std::uint64_t n, std::map<std::string, std::uint64_t> counts,
               double ns = 100) {
    Record record;
    record.case_id = id;
    record.backend = backend;
    record.level = "watertight";
    record.reference = "f64";
    record.n = n;
    record.counts = std::move(counts);
    record.pass = true;
    record.time = TimeFigures{"ns_per_ray", ns, {ns, ns}, 0, ns, 3};
    record.error = ErrorFigures{"t_ulp", 0.5, 2.25, {2, 3}, 7, 0.5};
    for (const auto& [kind, count] : record.counts)
        if (kind.starts_with("HW_")) record.faults += count;
    if (record.faults) record.pass = false, record.fault_of = "driver";
    return record;
}

TEST(Wording, RatesSayHowSureTheyAre) {
    EXPECT_EQ(rate_text(0, 2'100'000), "0 of 2.1 million (below 1.4 per million)");
    EXPECT_EQ(rate_text(460, 10'000), "4.6 % (4.2 to 5)");
    EXPECT_EQ(rate_text(27'000, 100'000), "27 % (26.7 to 27.3)");
    EXPECT_EQ(rate_text(4'096, 4'096), "100 % (99.9 to 100)");
    EXPECT_EQ(number(99.6, 2), "100");
    EXPECT_EQ(rate_text(5, 1'000'000), "5 per million (1.6 to 12)");
    EXPECT_EQ(count_text(8192), "8,192");
    EXPECT_EQ(number(1250), "1250");
    EXPECT_EQ(number(0.001234), "0.00123");
}

Finding finding_in(const std::vector<Record>& records, const char* backend, Mistake mistake) {
    const std::vector<Finding> findings = findings_of(records);
    const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
        return finding.backend == backend && finding.mistake == mistake;
    });
    return found == findings.end() ? Finding() : *found;
}

TEST(Findings, TheRateIsThatOfAimedRaysAndFaultsElsewhereAreToldBesideIt) {
    const std::vector<Record> records = {
        checked("W04", "hw", 1000, {{"HW_LEAK", 46}, {"AGREE", 954}}), checked("W05", "hw", 1000, {{"AGREE", 1000}}),
        checked("N01", "hw", 5000, {{"HW_LEAK", 5}, {"HW_FALSE", 2}}), checked("W04", "sw", 1000, {{"AGREE", 1000}})};
    const Finding leaks = finding_in(records, "hw", Mistake::leak),
                  falses = finding_in(records, "hw", Mistake::false_hit);
    EXPECT_DOUBLE_EQ(leaks.rate(), 0.023);
    EXPECT_EQ(leaks.n(), 2000u);
    EXPECT_EQ(leaks.cases_run, 2u);
    EXPECT_FALSE(leaks.is_complete());
    ASSERT_EQ(leaks.elsewhere.size(), 1u);
    EXPECT_EQ(leaks.elsewhere[0].case_id, "N01");
    EXPECT_EQ(text_of(leaks),
              "2.3 % (1.7 to 3.1) over 2 cases, most in W04, 4.6 % (3.2 to 6.3), and in N01 5 of 5,000");
    EXPECT_EQ(falses.n(), 7000u);
    EXPECT_TRUE(falses.has_faults());
    EXPECT_FALSE(finding_in(records, "sw", Mistake::leak).has_faults());
}

TEST(Findings, ARayCountsOnceThoughLevelsTraceItAgain) {
    std::vector<Record> records;
    for (const char* level : {"watertight", "refined", "certified", "fast"}) {
        records.push_back(checked("W04", "hw", 1000, {{"HW_LEAK", 10}}));
        records.back().level = level;
    }
    EXPECT_EQ(finding_in(records, "hw", Mistake::leak).n(), 1000u);
    EXPECT_EQ(finding_in(records, "hw", Mistake::leak).level, "watertight");
    records[1].counts = {{"HW_LEAK", 11}};
    EXPECT_EQ(finding_in(records, "hw", Mistake::leak).level, "refined") << "the one with the most faults";
}

// The rate does not depend on how thoroughly each case was asked.
TEST(Findings, TheRateIsTheMeanOfCasesAndOfTheKindsOfRaysInThem) {
    std::vector<Record> records = {checked("W04", "hw", 1'000'000, {{"HW_LEAK", 20'000}}),
                                   checked("W05", "hw", 1000, {{"HW_LEAK", 80}}),
                                   checked("W05", "hw", 10'000, {{"HW_LEAK", 400}})};
    records[2].params = {{"aim", "edge"}};
    EXPECT_DOUBLE_EQ(finding_in(records, "hw", Mistake::leak).rate(), (0.02 + (0.08 + 0.04) / 2) / 2);
}

std::vector<Record> all_cases_of(suite::Subject subject, const char* backend) {
    std::vector<Record> records;
    for (const std::string_view id : suite::cases_about(subject))
        records.push_back(checked(std::string(id).c_str(), backend, 1000, {{"AGREE", 1000}}));
    return records;
}

Sentence sentence_about(const Verdict& verdict, const char* about) {
    const auto found = std::ranges::find(verdict.sentences, about, &Sentence::about);
    return found == verdict.sentences.end() ? Sentence{Sentence::Kind::measured, "", ""} : *found;
}

TEST(Verdict, NothingIsRightUnlessAllItsCasesRan) {
    std::vector<Record> records = all_cases_of(suite::Subject::aimed_rays, "hw");
    const std::string all = text(records.size());
    const char* about = "Rays lost at edges and vertices";
    EXPECT_EQ(sentence_about(verdict_of(records), about).kind, Sentence::Kind::right);
    records.pop_back();
    const Sentence sentence = sentence_about(verdict_of(records), about);
    EXPECT_EQ(sentence.kind, Sentence::Kind::not_measured);
    EXPECT_TRUE(sentence.text.starts_with("not measured (" + text(records.size()) + " of " + all + " cases ran): "))
        << sentence.text;
    records.push_back(checked("N01", "hw", 1000, {{"HW_LEAK", 1}, {"AGREE", 999}}));
    EXPECT_EQ(sentence_about(verdict_of(records), about).kind, Sentence::Kind::wrong) << "a leak is one anywhere";
}

TEST(Verdict, BothWhoAnswerMustHaveRun) {
    std::vector<Record> records = all_cases_of(suite::Subject::aimed_rays, "hw");
    records.push_back(checked("W04", "sw", 1000, {{"AGREE", 1000}}));
    EXPECT_EQ(sentence_about(verdict_of(records), "Rays lost at edges and vertices").kind,
              Sentence::Kind::not_measured);
}

TEST(Verdict, EachClaimRestsOnCasesOfTheCatalogue) {
    std::set<std::string> ids;
    for (const suite::SuiteCase& row : suite::catalogue()) ids.insert(row.id);
    for (const suite::Subject subject : {suite::Subject::aimed_rays, suite::Subject::hits, suite::Subject::crossings})
        for (const std::string_view id : suite::cases_about(subject)) EXPECT_TRUE(ids.contains(std::string(id))) << id;
}

// Drivers have a known fault rate: their cases have different sizes, each with kinds of rays.
TEST(Findings, TheirIntervalsHoldTheTruth) {
    std::mt19937_64 random(1);
    for (const double rate : {0.0, 1e-4, 1e-3, 1e-2}) {
        int held = 0;
        constexpr int seeds = 300;
        for (int seed = 0; seed < seeds; ++seed) {
            std::vector<Record> records;
            for (const char* id : {"W01", "W02", "W03", "W05", "W16"})
                for (const std::uint64_t n : {2048u, 8192u}) {
                    const auto lost = std::binomial_distribution<std::uint64_t>(n, rate)(random);
                    for (const char* level : {"watertight", "refined"}) {  // both ask the same rays
                        records.push_back(checked(id, "hw", n, {{"HW_LEAK", lost}, {"AGREE", n - lost}}));
                        records.back().params = {{"n", n}};
                        records.back().level = level;
                    }
                }
            const Interval interval = finding_in(records, "hw", Mistake::leak).rate_95();
            held += interval.low <= rate && rate <= interval.high;
        }
        EXPECT_GE(held, 0.95 * seeds) << rate;
    }
}

TEST(Verdict, SaysWhatTheDriverDoesWrongFirst) {
    const Verdict verdict = verdict_of(std::vector{checked("W04", "hw", 10'000, {{"HW_LEAK", 460}}, 300),
                                                   checked("W04", "sw", 10'000, {{"AGREE", 10'000}})});
    EXPECT_TRUE(verdict.headline.starts_with("This driver loses rays at edges and vertices. Only 1 of "))
        << verdict.headline;
    EXPECT_FALSE(verdict.is_driver_right);
    EXPECT_TRUE(verdict.are_we_right);
    ASSERT_FALSE(verdict.sentences.empty());
    EXPECT_EQ(verdict.sentences[0].kind, Sentence::Kind::wrong);
    EXPECT_EQ(verdict.sentences[0].text,
              "by the driver's ray queries 4.6 % (4.2 to 5) over 1 case, most in W04, 4.6 % (4.2 to 5); by SwTlas 0 of "
              "10,000 rays of 1 case (below 300 per million).");
    const auto speed = std::find_if(verdict.sentences.begin(), verdict.sentences.end(),
                                    [](const Sentence& sentence) { return sentence.about == "Speed"; });
    ASSERT_NE(speed, verdict.sentences.end());
    EXPECT_NE(speed->text.find("take 3 (3 to 3) times as long"), std::string::npos) << speed->text;
}

TEST(Verdict, OwnStructuresThatBreakADemandAreInTheHeadline) {
    Record right = checked("W04", "hw", 1000, {{"AGREE", 1000}}), wrong = checked("K07", "hw", 1000, {{"LOST", 10}});
    right.pass = true, wrong.pass = false, wrong.fault_of = "driver";
    wrong.results.insert_or_assign("demand", "should");
    const auto starts = [&](const char* with) {
        return verdict_of(std::vector{right, wrong}).headline.starts_with(with);
    };
    EXPECT_TRUE(starts("This driver's ray tracing showed no fault. Only 1 of "));
    wrong.results.insert_or_assign("demand", "must");
    EXPECT_TRUE(starts("This driver breaks requirements of Vulkan on acceleration structures."));
}

TEST(Verdict, AFaultThatNoFindingCountsIsInTheHeadline) {
    Record wrong = checked("S02", "hw", 1000, {{"DIFFERS", 10}});
    wrong.pass = false, wrong.fault_of = "driver";
    EXPECT_TRUE(verdict_of(std::vector{wrong}).headline.starts_with("This driver is wrong in 1 measurement."));
}

TEST(Verdict, AFaultOfOursComesFirst) {
    Record wrong = checked("W04", "sw", 1000, {{"SW_LEAK", 1}});
    wrong.pass = false, wrong.fault_of = "twinray";
    const Verdict verdict = verdict_of(std::vector{wrong});
    EXPECT_FALSE(verdict.are_we_right);
    EXPECT_TRUE(verdict.headline.starts_with("twinray is wrong in 1 measurement."));
    EXPECT_FALSE(verdict.has_driver);
}

TEST(Verdict, NegativeControlsAndFastDoNotCount) {
    Record control = checked("W04", "sw", 1000, {{"SW_LEAK", 99}}), fast = control;
    control.variant = "control: without precise";
    fast.level = "fast";
    EXPECT_TRUE(findings_of(std::vector{control, fast}).empty());
}

TEST(Verdict, TimesAreOverThoseOfWatertight) {
    Record refined = checked("W04", "sw", 4096, {}, 150), base = checked("W04", "sw", 4096, {});
    refined.level = "refined";
    const std::vector<Speed> speeds = speeds_of(std::vector{base, refined, checked("W05", "hw", 4096, {})});
    ASSERT_EQ(speeds.size(), 2u) << "what has no counterpart is left out";
    EXPECT_EQ(speeds[0].level, "refined");
    EXPECT_NEAR(speeds[0].ratio, 1.5, 1e-12);
    EXPECT_EQ(speeds[0].median_p99_ulp, 2.25);
}

Record measured(const std::string& id, double ns, std::uint64_t leaks = 0, std::uint64_t n = 4096,
                const char* backend = "hw") {
    Record record = checked(id.c_str(), backend, n, {{"AGREE", n - leaks}, {"HW_LEAK", leaks}}, ns);
    record.params = {{"aim", "vertex"}};
    record.seed = 1;
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
