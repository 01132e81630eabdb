// SPDX-License-Identifier: MIT
#include "validation/report/page.h"

#include <gtest/gtest.h>

namespace twinray::report {
namespace {

Record record(const char* id, const char* level, double ns, std::optional<bool> pass = true) {
    Record result;
    result.device = {"llvm<pipe> & co", "Mesa", "1.4", {{"fma_fused", false}}};
    result.case_id = id;
    result.backend = "sw";
    result.level = level;
    result.n = 1000;
    result.counts = {{"AGREE", 1000}};
    result.bound95 = upper_bound_95(0, 1000);
    result.pass = pass;
    result.error = ErrorFigures{"t_ulp", 0.5, 2.25, {2, 3}, 7, 0.5};
    result.time = TimeFigures{"ns_per_ray", ns, {ns, ns}, 0, ns, 3};
    return result;
}

std::string page_of(const std::vector<Record>& records, const std::vector<Change>& changes = {},
                    const std::string& baseline = {}) {
    static const std::vector<suite::SuiteCase> catalogue = suite::catalogue();
    return page({"quick", catalogue, records, baseline, changes});
}

bool has(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

TEST(Page, ShowsDeviceProbeCaseAndResult) {
    const std::string page = page_of({record("W01", "watertight", 400)});
    EXPECT_TRUE(has(page, "llvm&lt;pipe&gt; &amp; co"));
    EXPECT_TRUE(has(page, "<dt>fma_fused</dt><dd>false</dd>"));
    EXPECT_TRUE(has(page, "<h3 id=\"W01\">"));
    EXPECT_TRUE(has(page, "No fault of ours"));
    EXPECT_TRUE(has(page, "0.5 / 2.25 / 7"));
    EXPECT_TRUE(has(page, "<svg"));
}

TEST(Page, AFaultOfOursIsInTheFirstLine) {
    Record bad = record("W04", "watertight", 400, false);
    bad.fault_of = "twinray";
    bad.faults = 3;
    bad.example = "SW_LEAK 0x1p+0";
    bad.replay = "replays/W04-1.json";
    const std::string page = page_of({bad});
    EXPECT_TRUE(has(page, "1 measurements show faults of ours"));
    EXPECT_FALSE(has(page, "No fault of ours"));
    EXPECT_TRUE(has(page, "SW_LEAK 0x1p+0"));
    EXPECT_TRUE(has(page, "<a href=\"replays/W04-1.json\">replay</a>"));
}

TEST(Page, ListsWhatWasNotRunByReason) {
    Record first = record("B11", "", 0), second = record("B13", "", 0);
    for (Record* skipped : {&first, &second}) {
        skipped->was_run = false;
        skipped->backend.clear();
        skipped->pass.reset();
        skipped->reason = "nobody wrote it";
    }
    EXPECT_TRUE(has(page_of({first, second}), "<tr><td>all</td><td>B11 B13</td><td>nobody wrote it</td></tr>"));
}

TEST(Page, ShowsWhatIsWorseThanTheBaseline) {
    const std::vector<Record> records = {record("W01", "watertight", 400)};
    EXPECT_TRUE(has(page_of(records, {{"W01 sw", "ns 1 -> 2", true}}, "old.jsonl"), "<td>W01 sw</td>"));
    EXPECT_TRUE(has(page_of(records, {}, "old.jsonl"), "<p>Nothing.</p>"));
    EXPECT_FALSE(has(page_of(records), "id=\"baseline\""));
}

TEST(Page, RefersToNothingOutside) {
    const std::string page = page_of({record("W01", "watertight", 400)});
    EXPECT_FALSE(has(page, "src="));
    EXPECT_FALSE(has(page, "href="));
    EXPECT_FALSE(has(page, "@import"));
    EXPECT_FALSE(has(page, "url("));
}

TEST(LevelPrices, AreRatiosToWatertightOfTheSameMeasurement) {
    const std::vector<LevelPrice> prices = level_prices(std::vector<Record>{
        record("W01", "watertight", 100), record("W01", "refined", 110), record("W02", "watertight", 100),
        record("W02", "refined", 130), record("W03", "refined", 900)});
    ASSERT_EQ(prices.size(), 2u);
    EXPECT_EQ(prices[0].level, "watertight");
    EXPECT_EQ(prices[0].median, 1);
    EXPECT_EQ(prices[1].level, "refined");
    EXPECT_NEAR(prices[1].median, 1.2, 1e-12);
    EXPECT_NEAR(prices[1].low, 1.1, 1e-12);
    EXPECT_NEAR(prices[1].high, 1.3, 1e-12);
    EXPECT_EQ(prices[1].measurements, 2u);
    EXPECT_EQ(prices[1].worst_p99, 2.25);
}

}  // namespace
}  // namespace twinray::report
