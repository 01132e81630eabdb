// SPDX-License-Identifier: MIT
#include "report/page/verdict.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/core/error.h"
#include "report/page/wording.h"
#include "report/suite/claims.h"
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

}  // namespace
}  // namespace twinray::report
