// SPDX-License-Identifier: MIT
#include "report/page/page.h"

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
    return page({.suite = "quick",
                 .catalogue = catalogue,
                 .records = records,
                 .baseline = baseline,
                 .changes = changes,
                 .figures = {{Figure{.id = "leaks", .title = "Leaks"}, "<svg id=\"drawn\"></svg>"}}});
}

bool has(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

TEST(Page, ShowsDeviceProbeCaseAndResult) {
    const std::string page = page_of({record("W01", "watertight", 400)});
    EXPECT_TRUE(has(page, "llvm&lt;pipe&gt; &amp; co"));
    EXPECT_TRUE(has(page, "<dt>fma_fused</dt><dd>false</dd>"));
    EXPECT_TRUE(has(page, "<details id=\"W01\">"));
    EXPECT_TRUE(has(page, "SwTlas alone was checked"));
    EXPECT_TRUE(has(page, "<td>2.25</td><td>400</td><td class=\"pass\">pass</td>"));
    EXPECT_TRUE(has(page, "<svg id=\"drawn\">"));
}

TEST(Page, AFaultOfOursIsInTheFirstLine) {
    Record bad = record("W04", "watertight", 400, false);
    bad.fault_of = "twinray";
    bad.faults = 3;
    bad.example = "SW_LEAK 0x1p+0";
    bad.replay = "replays/W04-1.json";
    const std::string page = page_of({bad});
    EXPECT_TRUE(has(page, "<p class=\"headline bad\">twinray is wrong in 1 measurement."));
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

TEST(Page, ShowsWhatChangedSinceTheBaseline) {
    const std::vector<Record> records = {record("W01", "watertight", 400)};
    EXPECT_TRUE(has(page_of(records, {{Change::Kind::slower, "W01 sw", "ns 1 -> 2"}}, "old.jsonl"),
                    "<li class=\"slower\">W01 sw: ns 1 -&gt; 2</li>"));
    EXPECT_TRUE(has(page_of(records, {}, "old.jsonl"), "<p>Nothing beyond noise.</p>"));
    EXPECT_FALSE(has(page_of(records), "id=\"baseline\""));
}

TEST(Page, SaysWhichPlotsCouldNotBeDrawn) {
    const std::vector<Record> records = {record("W01", "watertight", 400)};
    const PageInput input{.suite = "quick",
                          .catalogue = {},
                          .records = records,
                          .figures = {{Figure{.id = "leaks", .title = "Leaks"}, ""}}};
    EXPECT_TRUE(has(page(input), "gnuplot is not installed"));
}

TEST(Page, RefersToNothingOutside) {
    const std::string page = page_of({record("W01", "watertight", 400)});
    EXPECT_FALSE(has(page, "src="));
    EXPECT_FALSE(has(page, "href=\"http"));
    EXPECT_FALSE(has(page, "<script"));
    EXPECT_FALSE(has(page, "@import"));
    EXPECT_FALSE(has(page, "url("));
}

}  // namespace
}  // namespace twinray::report
