// SPDX-License-Identifier: MIT
#include "validation/report/verdict.h"

#include <gtest/gtest.h>

#include "validation/report/wording.h"

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

TEST(Verdict, LeaksAreCountedWhereRaysAreAimed) {
    const std::vector<Record> records = {
        checked("W04", "hw", 1000, {{"HW_LEAK", 46}, {"AGREE", 954}}), checked("W05", "hw", 1000, {{"AGREE", 1000}}),
        checked("N01", "hw", 5000, {{"HW_LEAK", 5}, {"HW_FALSE", 2}}), checked("W04", "sw", 1000, {{"AGREE", 1000}})};
    const std::vector<Finding> findings = findings_of(records);
    const auto find = [&](const char* backend, Mistake mistake) {
        return *std::find_if(findings.begin(), findings.end(),
                             [&](const Finding& f) { return f.backend == backend && f.mistake == mistake; });
    };
    EXPECT_EQ(find("hw", Mistake::leak).faults, 46u);
    EXPECT_EQ(find("hw", Mistake::leak).n, 2000u);
    EXPECT_EQ(find("hw", Mistake::leak).worst_case, "W04");
    EXPECT_EQ(find("hw", Mistake::false_hit).faults, 2u);
    EXPECT_EQ(find("hw", Mistake::false_hit).n, 7000u);
    EXPECT_EQ(find("sw", Mistake::leak).faults, 0u);
}

TEST(Verdict, SaysWhatTheDriverDoesWrongFirst) {
    const Verdict verdict = verdict_of(std::vector{checked("W04", "hw", 10'000, {{"HW_LEAK", 460}}, 300),
                                                   checked("W04", "sw", 10'000, {{"AGREE", 10'000}})});
    EXPECT_EQ(verdict.headline, "This driver loses rays at edges and vertices.");
    EXPECT_FALSE(verdict.is_driver_right);
    EXPECT_TRUE(verdict.are_we_right);
    ASSERT_FALSE(verdict.sentences.empty());
    EXPECT_EQ(verdict.sentences[0].kind, Sentence::Kind::wrong);
    EXPECT_EQ(verdict.sentences[0].text,
              "by the driver's ray queries 4.6 % (4.2 to 5); by SwTlas 0 of 10,000 (below 300 per million).");
    const auto speed = std::find_if(verdict.sentences.begin(), verdict.sentences.end(),
                                    [](const Sentence& sentence) { return sentence.about == "Speed"; });
    ASSERT_NE(speed, verdict.sentences.end());
    EXPECT_NE(speed->text.find("take 3 (3 to 3) times as long"), std::string::npos) << speed->text;
}

TEST(Verdict, OwnStructuresThatBreakADemandAreInTheHeadline) {
    Record right = checked("W04", "hw", 1000, {{"AGREE", 1000}}), wrong = checked("K07", "hw", 1000, {{"LOST", 10}});
    right.pass = true, wrong.pass = false, wrong.fault_of = "driver";
    wrong.results.insert_or_assign("demand", "should");
    EXPECT_EQ(verdict_of(std::vector{right, wrong}).headline, "No fault of this driver's ray tracing was seen.");
    wrong.results.insert_or_assign("demand", "must");
    EXPECT_EQ(verdict_of(std::vector{right, wrong}).headline,
              "This driver fails what Vulkan demands of acceleration structures.");
}

TEST(Verdict, AFaultThatNoFindingCountsIsInTheHeadline) {
    Record wrong = checked("S02", "hw", 1000, {{"HW_LEAK", 10}});
    wrong.pass = false, wrong.fault_of = "driver";
    EXPECT_EQ(verdict_of(std::vector{wrong}).headline, "This driver is wrong in 1 measurement.");
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
